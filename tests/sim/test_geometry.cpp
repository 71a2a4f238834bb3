#include "sim/measures/diagnostics.h"
#include "sim/surface/correction.h"
#include "sim/surface/dealias.h"
#include "surfaces.h"
#include "tests/support/catch.h"

using namespace sim;
using test::pi;

namespace {

Geometry fine_geometry(const Coefficients& x, int grid_order = 48) { return geometry(Basis(x.order, grid_order), x); }

}  // namespace

TEST_CASE("a sphere of radius 2 has H = -1/2, K = 1/4 and an outward normal") {
  VesicleParameters v = test::vesicle("sphere", 1, 6);
  v.radius = 2;
  const Geometry g = fine_geometry(initial_position(v), 12);
  CHECK((g.H.array() + 0.5).abs().maxCoeff() < 1e-13);
  CHECK((g.K.array() - 0.25).abs().maxCoeff() < 1e-13);
  CHECK((g.n - g.x.value / 2).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("Gauss-Bonnet: the Gaussian curvature of any of our surfaces adds up to 4 pi") {
  for (const Coefficients& x :
       {test::surface("prolate", 0.85, 12), test::surface("biconcave", 0.65, 12), test::potato(12)}) {
    const Geometry g = fine_geometry(x);
    CHECK(integrate(g, g.K) == Approx(4 * pi).epsilon(1e-9));  // quadrature error of the 48-grid
  }
}

TEST_CASE("the surface Laplacian of the position is 2 H n") {
  const Coefficients x = test::potato(10);
  const Basis basis(10, 30);
  const Geometry g = geometry(basis, x);
  for (int d = 0; d < 3; ++d) {
    const Vector lap = surface_laplacian(g, basis.second({10, x.values.col(d)}));
    CHECK((lap - 2 * g.H.cwiseProduct(g.n.col(d))).cwiseAbs().maxCoeff() < 1e-10);
  }
}

TEST_CASE("int div u dA = -2 int H u.n dA for any velocity") {
  const Coefficients x = test::potato(10), u = test::smooth_field(10, 6, 3, 11);
  const Basis basis(10, 48);
  const Geometry g = geometry(basis, x);
  const FirstDerivatives field = basis.first(u);
  const double left = integrate(g, surface_divergence(g, field.t, field.f));
  const double right = -2 * integrate(g, g.H.cwiseProduct(field.value.cwiseProduct(g.n).rowwise().sum()));
  CHECK(left == Approx(right).epsilon(1e-9));
}

TEST_CASE("the divergence of the gradient is the Laplacian") {
  const Coefficients x = test::surface("prolate", 0.85, 8), f = test::smooth_field(8, 4, 1, 2);
  const Basis basis(8, 40), full(40, 40);
  const Geometry g = geometry(basis, x);
  const Coefficients gradient = full.analyze(surface_gradient(g, basis.first(f)));
  const FirstDerivatives d = full.first(gradient);
  CHECK((surface_divergence(g, d.t, d.f) - surface_laplacian(g, basis.second(f))).cwiseAbs().maxCoeff() <
        1e-5);  // gradient cut at degree 40
}

TEST_CASE("areas, volumes and energies of the catalogue's shapes are the exact ones") {
  struct Row {
    Coefficients x;
    double nu, area, volume, energy, tolerance;
  };
  VesicleParameters dumbbell;
  dumbbell.shape = "harmonics";
  dumbbell.coefficients = {{2, 0, 1}};
  dumbbell.area = 16.222844295934;
  dumbbell.order = 12;
  const Row rows[] = {
      {test::ellipsoid({0.47, 1, 1}, 8), 0.850059, 8.465303, 1.968731, 1.42464626, 1e-6},
      {test::ellipsoid({0.29, 1, 1}, 8), 0.649980, 7.337393, 1.214749, 2.60704666, 1e-6},
      {test::surface("prolate", 0.85, 8), 0.85, 12.566371, 3.560472, 1.34979897, 1e-7},
      {test::surface("biconcave", 0.65, 8), 0.65, 12.566371, 0.65 * 4 * pi / 3, 1.928624, 1e-6},
      {initial_position(dumbbell), 0.8542816, 16.222844295934, 5.248864788644, 1.377588, 1e-6},
  };
  for (const Row& row : rows) {
    const Measures m = measures(fine_geometry(row.x, 64));
    CHECK(m.area == Approx(row.area).epsilon(row.tolerance));
    CHECK(m.volume == Approx(row.volume).epsilon(row.tolerance));
    CHECK(reduced_volume(m.area, m.volume) == Approx(row.nu).epsilon(row.tolerance));
    CHECK(m.h_squared / (4 * pi) == Approx(row.energy).epsilon(row.tolerance));
  }
  const Vec3 axes = spheroid_axes(0.85, true);
  CHECK(axes[0] == Approx(1.676919960).epsilon(1e-9));
  CHECK(axes[1] == Approx(0.711956232).epsilon(1e-9));
}

TEST_CASE("second moments give back the semi-axes, the centre and the inclination of an ellipsoid") {
  VesicleParameters v;
  v.shape = "ellipsoid";
  v.axes = Vec3(1.5, 0.9, 0.7);
  v.order = 6;
  v.center = {3, -2, 5};
  v.axis = Vec3(std::cos(0.4), 0, std::sin(0.4));
  VesicleState s;
  s.position = initial_position(v);
  s.velocity = test::constant_field(6, {3, 0, 4});
  s.tension = {6, Matrix::Zero(49, 1)};
  Plans plans;
  const VesicleMeasures m = measure(plans, s, 1, 1);
  CHECK((m.axes - *v.axes).norm() < 1e-12);
  CHECK((m.center - v.center).norm() < 1e-12);
  CHECK(m.inclination_deg == Approx(0.4 * 180 / pi).epsilon(1e-12));
  CHECK(m.velocity_l2 == Approx(5 * std::sqrt(m.area)).epsilon(1e-12));
}

TEST_CASE("the grid's pole lies on the shape's axis") {
  VesicleParameters v = test::vesicle("prolate", 0.85, 8);
  v.axis = Vec3(0, 2, 0);
  const Matrix pole = sample_points(initial_position(v), Vec3::UnitZ().transpose());
  CHECK((pole - Eigen::RowVector3d(0, 1.676919960, 0)).norm() < 1e-8);
}

TEST_CASE("the correction restores area and volume, also on a sphere, where its two directions coincide") {
  Plans plans;
  for (const char* shape : {"prolate", "sphere"}) {
    const Coefficients x = test::surface(shape, 0.85, 8);
    const AreaVolume target = area_volume(plans.basis(8, measure_order(8)), x);
    Coefficients blown = x;
    blown.values *= 1.003;
    const Correction c = area_volume_correction(plans, blown, target.area, target.volume);
    CHECK(c.converged);
    CHECK(std::abs(c.area / target.area - 1) < 1e-11);
    CHECK(std::abs(c.volume / target.volume - 1) < 1e-11);
  }
}

TEST_CASE("Algorithm 1 finds a rate whose aliasing error is within the tolerance") {
  Plans plans;
  const Coefficients x = test::surface("prolate", 0.85, 8);
  const Coefficients exact = mean_curvature(plans, x, 80);
  double before = 0;
  for (const double tolerance : {1e-1, 1e-3, 1e-5, 1e-7}) {
    const double rate = upsampling_rate(plans, x, tolerance);
    CHECK((mean_curvature(plans, x, upsampled(8, rate)).values - exact.values).norm() <=
          tolerance * exact.values.norm());
    CHECK(rate >= before);
    before = rate;
  }
}
