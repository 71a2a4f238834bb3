// Viscosity contrasts at which a double has too few digits, or an order too few degrees.
#include "sim/measures/statement.h"
#include "sim/stepping/warnings.h"
#include "surfaces.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

using namespace sim;
using Catch::Contains;

namespace {

Scene scene_of(double contrast, int order) {
  return test::shear_scene(test::vesicle("prolate", 0.9, order, contrast), 0.1, 1);
}

std::string refusal(const Scene& scene) {
  Plans plans;
  return support::message_of([&] { initial_dynamics(make_model(scene, plans)); });
}

std::string warnings(const Scene& scene) {
  Plans plans;
  const Model s = make_model(scene, plans);
  std::string all;
  for (const std::string& warning : scene_warnings(s, initial_dynamics(s))) all += warning + "\n";
  return all;
}

}  // namespace

TEST_CASE("a contrast below what the quadrature of rigid motions errs by is refused with an order that would do") {
  Plans plans;
  const double error = quadrature_error(plans, test::surface("prolate", 0.9, 8));
  REQUIRE((error > 1e-5 && error < 2e-4));
  CHECK_THAT(refusal(scene_of(1e-5, 8)), Contains("vesicle.viscosity_contrast = 1e-05 of vesicle 0 is too small") &&
                                             Contains("in order 8 the double layer of a rigid motion errs by ") &&
                                             Contains("vesicle.order = 14 would do"));
  CHECK_THAT(warnings(scene_of(1e-5, 14)), !Contains("contrast"));  // it does
  CHECK_THAT(warnings(scene_of(1.01 * error, 8)), Contains("is small for its order") && Contains("would do"));
  CHECK_THAT(refusal(scene_of(0.99 * error, 8)), Contains("or a contrast of "));
  CHECK_THAT(warnings(scene_of(1e-2, 8)), !Contains("contrast"));
}

TEST_CASE("an automatic order is not refused for a small contrast: it rises") {
  Scene scene = scene_of(1e-6, 0);
  scene.time.step.reset();
  scene.time.scheme.reset();
  CHECK_THAT(warnings(scene), !Contains("contrast"));
}

TEST_CASE("a contrast that leaves no digits is refused, the largest that leaves some is not") {
  Scene scene = scene_of(1, 4);
  scene.vesicles.push_back(scene.vesicles[0]);
  scene.vesicles[1].center = {5, 0, 0};
  scene.vesicles[1].viscosity_contrast = 1e16;
  CHECK_THAT(refusal(scene), Contains("viscosity_contrast = 1e+16 of vesicle 1 is too large to compute with") &&
                                 Contains("1000 is near a rigid body"));
  scene.vesicles[1].viscosity_contrast = 1e15;
  CHECK_THAT(warnings(scene), !Contains("contrast"));
}
