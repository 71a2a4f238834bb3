// The shapes, flows and scenes that the reproduced tables and figures share.
#include "app/reproduce/reproduce_items.h"

#include <cmath>
#include <numbers>

namespace app {

const std::vector<NamedShape>& reference_shapes() {
  static const std::vector<NamedShape> shapes = [] {
    std::vector<NamedShape> all(4);
    all[0].name = "prolate, ν = 0.85";
    all[0].parameters.shape = "prolate";
    all[0].parameters.reduced_volume = 0.85;
    all[1].name = "ellipsoid (1, 0.8, 0.6)";
    all[1].parameters.shape = "ellipsoid";
    all[1].parameters.axes = sim::Vec3(1, 0.8, 0.6);
    all[2].name = "biconcave, ν = 0.65";
    all[2].parameters.shape = "biconcave";
    all[2].parameters.reduced_volume = 0.65;
    // sin^3 t cos 3f = sqrt(32 pi/35) Y_33
    all[3].name = "ρ = 1 + 0.3 sin³t cos 3f";
    all[3].parameters.shape = "harmonics";
    all[3].parameters.coefficients = {{3, 3, 0.3 * std::sqrt(32 * std::numbers::pi / 35)}};
    return all;
  }();
  return shapes;
}

sim::Scene sheared_prolate(int order, double viscosity_contrast) {
  sim::Scene scene;
  sim::FlowParameters shear;
  shear.kind = "shear";
  scene.flows = {shear};
  sim::VesicleParameters vesicle;
  vesicle.shape = "prolate";
  vesicle.reduced_volume = 0.85;
  vesicle.order = order;
  vesicle.viscosity_contrast = viscosity_contrast;
  vesicle.bending_modulus = 0.01;
  scene.vesicles = {vesicle};
  return scene;
}

sim::Scene sheared_pair(int order, double viscosity_contrast) {
  sim::Scene scene = sheared_prolate(order, viscosity_contrast);
  scene.vesicles.push_back(scene.vesicles[0]);
  scene.vesicles[0].center = {-1.2, 0, 0.5};
  scene.vesicles[1].center = {1.2, 0, -0.5};
  return scene;
}

const char* const poiseuille_scene = R"(title = "A biconcave vesicle in Poiseuille flow"

[flow]
kind = "poiseuille"
curvature = 0.1

[time]
end = 40.0
step = 0.05
save_every = 5.0

[[vesicle]]
shape = "biconcave"
reduced_volume = 0.65
axis = [1, 0, 0]
order = 8
viscosity_contrast = 1.0
bending_modulus = 0.01
)";

const char* const two_vesicles_scene = R"(title = "Two vesicles in shear flow"

[flow]
kind = "shear"
rate = 1.0

[time]
end = 69.3
step = 0.21
scheme = "bdf2"

[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
center = [-1.2, 0, 0.5]
axis = [1, 0, 0]
order = 8
viscosity_contrast = 10.0
bending_modulus = 0.01

[[vesicle]]
shape = "prolate"
reduced_volume = 0.85
center = [1.2, 0, -0.5]
axis = [1, 0, 0]
order = 8
viscosity_contrast = 10.0
bending_modulus = 0.01

[numerics]
repulsion_strength = 100.0
repulsion_range = 0.02
)";

}  // namespace app
