// Every row of every catalogue of the simulation against what its name and its meaning promise, from closed forms. A
// row without an entry here fails.
#include "../support/temporary_folder.h"
#include "sim/measures/diagnostics.h"
#include "sim/measures/fields.h"
#include "sim/membrane/flows.h"
#include "sim/surface/geometry.h"
#include "sim/surface/shapes.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <fstream>
#include <map>

using namespace sim;
using test::pi;

TEST_CASE("every flow of the catalogue has the velocity that its meaning says") {
  FlowParameters f;
  f.rate = 1.3, f.curvature = 0.4, f.centreline_velocity = 2, f.angular_velocity = {1, 2, 3}, f.velocity = {4, 5, 6};
  f.wavelength = 6;
  f.planar = false;
  const double x = 0.3, y = -0.7, z = 1.1;
  const std::map<std::string_view, Vec3> exact{{"none", {0, 0, 0}},
                                               {"shear", {1.3 * z, 0, 0}},
                                               {"poiseuille", {2 - 0.4 * (y * y + z * z), 0, 0}},
                                               {"streams", {2 * std::cos(pi / 3 * y) * std::cos(pi / 3 * z), 0, 0}},
                                               {"extension", {1.3 * x, -0.65 * y, -0.65 * z}},
                                               {"rotation", {2 * z - 3 * y, 3 * x - z, y - 2 * x}},
                                               {"uniform", {4, 5, 6}}};
  for (const auto& row : flow_catalogue()) {
    INFO(row.name);
    REQUIRE(exact.contains(row.name));
    CHECK((row.function(f, Vec3(x, y, z)) - exact.at(row.name)).norm() < 1e-14);
  }
}

TEST_CASE("every field of the catalogue has its closed form on a sphere that turns beside another one") {
  const double radius = 1.7, sigma = 0.6, gap = 0.5, modulus = 0.02;
  const int order = 8;
  const Vec3 spin(0, 0.7, 0);
  const auto sphere = [&](double r, const Vec3& centre) {
    VesicleState v;
    v.position = test::ellipsoid(Vec3::Constant(r), order);
    v.velocity.order = order;
    v.velocity.values = test::cross_rows(spin, v.position.values) + test::constant_field(order, Vec3(3, 1, 2)).values;
    v.position.values += test::constant_field(order, centre).values;
    v.tension = {order, test::constant_field(order, Vec3::Constant(sigma)).values.leftCols(1)};
    return v;
  };
  const Vec3 other(0, 0, radius + gap + 1);
  State state;
  state.vesicles = {sphere(radius, Vec3::Zero()), sphere(1, other)};
  const Vec3 direction = Vec3(0.6, 0.3, 0.5).normalized();  // a parameter
  const Vec3 at = sample_points(state.vesicles[0].position, direction.transpose()).row(0).transpose();
  const std::map<std::string_view, double> exact{{"tension", sigma},
                                                 {"mean-curvature", 1 / radius},
                                                 {"gaussian-curvature", 1 / (radius * radius)},
                                                 {"bending-force", 0},
                                                 {"tension-force", 2 * sigma / radius},
                                                 {"normal-velocity", 0},
                                                 {"membrane-speed", spin.cross(at).norm()},
                                                 {"neighbour-distance", (at - other).norm() - 1}};
  Plans plans;
  for (const FieldRow& row : field_catalogue()) {
    INFO(row.name);
    REQUIRE(exact.contains(row.name));
    const Coefficients field = membrane_field(plans, row, state, 0, modulus);
    // Speed has a kink where it vanishes, the distance one behind the sphere: both to the eye.
    const double margin = row.name == "membrane-speed" || row.name == "neighbour-distance" ? 0.02 : 1e-8;
    CHECK(sample_points(field, direction.transpose())(0, 0) == Approx(exact.at(row.name)).margin(margin));
  }
}

TEST_CASE("every measure of a state has its closed form, on a leaning prolate or on a sphere that moves") {
  const int order = 12;
  Plans plans;
  // A prolate of reduced volume 0.85 and area 4 pi: semi-axes and energy of the closed forms of spheroids.
  VesicleParameters p = test::vesicle("prolate", 0.85, order);
  p.axis = Vec3(std::cos(0.3), 0, std::sin(0.3));
  p.center = {3, -2, 5};
  VesicleState prolate;
  prolate.position = initial_position(p);
  prolate.velocity = test::constant_field(order, Vec3::Zero());
  prolate.tension = {order, Matrix::Zero(coefficient_count(order), 1)};
  const double volume = 0.85 * 4 * pi / 3;
  const VesicleMeasures shape = measure(plans, prolate, 4 * pi / 1.1, volume / 0.9);
  // A sphere of radius 2 with a uniform velocity and a tension that is linear in z.
  const Vec3 velocity(1, -2, 2);
  VesicleState sphere;
  sphere.position = test::ellipsoid(Vec3::Constant(2), order);
  sphere.velocity = test::constant_field(order, velocity);
  sphere.tension = {order, Matrix(0.7 * test::constant_field(order, Vec3::Ones()).values.col(0) +
                                  0.05 * sphere.position.values.col(2))};
  const VesicleMeasures moving = measure(plans, sphere, 16 * pi, 32 * pi / 3);
  struct Exact {
    const VesicleMeasures& of;
    double value, margin = 1e-7;
  };
  const std::map<std::string_view, Exact> exact{{"area", {shape, 4 * pi}},
                                                {"volume", {shape, volume}},
                                                {"area_error", {shape, 0.1}},
                                                {"volume_error", {shape, -0.1}},
                                                {"reduced_volume", {shape, 0.85}},
                                                {"center_x", {shape, 3}},
                                                {"center_y", {shape, -2}},
                                                {"center_z", {shape, 5}},
                                                {"inclination_deg", {shape, 0.3 * 180 / pi}},
                                                {"axis_1", {shape, 1.676919960}},
                                                {"axis_2", {shape, 0.711956232}},
                                                {"axis_3", {shape, 0.711956232}},
                                                {"energy", {shape, 1.34979897}},
                                                {"velocity_l2", {moving, 3 * std::sqrt(16 * pi)}},
                                                {"normal_velocity_l2", {moving, 3 * std::sqrt(16 * pi / 3)}},
                                                {"tension_mean", {moving, 0.7}},
                                                {"tension_min", {moving, 0.6, 1e-3}},  // extremes on a grid
                                                {"tension_max", {moving, 0.8, 1e-3}}};
  std::size_t count = 0;
  visit(shape, [&](std::string_view name, std::string_view, double) {
    INFO(name);
    ++count;
    REQUIRE(exact.contains(name));
    visit(exact.at(name).of, [&](std::string_view other, std::string_view, double value) {
      if (other == name) CHECK(value == Approx(exact.at(name).value).margin(exact.at(name).margin));
    });
  });
  CHECK(count == exact.size());
}

TEST_CASE("every field of the catalogue has the dimension by which it is divided") {
  // Lengths times s, times times t, forces times g: a state in other units.
  const double s = 3, t = 0.5, g = 7;
  const std::map<FieldScale, double> factors{
      {FieldScale::length, s},      {FieldScale::curvature, 1 / s},   {FieldScale::square_curvature, 1 / (s * s)},
      {FieldScale::tension, g / s}, {FieldScale::force, g / (s * s)}, {FieldScale::velocity, s / t}};
  const auto state = [](double length, double time, double force) {
    State all;
    for (const double z : {-1.5, 1.5}) {
      VesicleState v;
      v.position = test::potato(8);
      v.position.values *= length;
      v.position.values += test::constant_field(8, Vec3(0, 0, z * length)).values;
      v.velocity = test::smooth_field(8, 3, 3, 7);
      v.velocity.values *= length / time;
      v.tension = test::smooth_field(8, 3, 1, 9);
      v.tension.values *= force / length;
      all.vesicles.push_back(std::move(v));
    }
    return all;
  };
  Plans plans;
  for (const FieldRow& row : field_catalogue()) {
    INFO(row.name);
    const double factor = factors.at(row.scale);
    const Matrix one = membrane_field(plans, row, state(1, 1, 1), 0, 0.02).values;
    const Matrix scaled = membrane_field(plans, row, state(s, t, g), 0, 0.02 * g * s).values;  // an energy
    CHECK((scaled - factor * one).norm() < 1e-9 * factor * one.norm());
  }
}

TEST_CASE("every shape of the catalogue is the surface that its meaning says") {
  const int order = 12;
  const support::TemporaryFolder folder;
  const Coefficients table = test::potato(order);
  {
    std::ofstream out(folder.path() / "shape.txt");
    out.precision(17);
    out << "coefficients\n";
    for (int n = 0; n <= order; ++n)
      for (int m = -n; m <= n; ++m) {
        const auto row = table.values.row(coefficient_index(n, m));
        out << n << ' ' << m << ' ' << row[0] << ' ' << row[1] << ' ' << row[2] << '\n';
      }
  }
  // What is 0 on the surface, its symmetry axis along z. Spheroids of the area 4 pi; for 0.85 the prolate one is tested
  // elsewhere.
  const auto spheroid = [](bool prolate) {
    return [prolate](const Vec3& x) {
      const Vec3 a = spheroid_axes(0.85, prolate);
      const double along = a[0], across = a[1];
      return (x[0] * x[0] + x[1] * x[1]) / (across * across) + x[2] * x[2] / (along * along) - 1;
    };
  };
  using Equation = std::function<double(const Vec3&)>;
  const std::map<std::string_view, Equation> exact{
      {"sphere", [](const Vec3& x) { return x.norm() - 1; }},
      {"prolate", spheroid(true)},
      {"oblate", spheroid(false)},
      {"ellipsoid", [](const Vec3& x) { return x[2] * x[2] / 4 + x[1] * x[1] + x[0] * x[0] / 0.25 - 1; }},
      {"harmonics",
       [](const Vec3& x) {  // the area stays as it is: 1 + value Y_20
         const double c = x[2] / x.norm();
         return x.norm() - (1 + 0.2 * std::sqrt(5 / (4 * pi)) * (1.5 * c * c - 0.5));
       }},
      {"biconcave", {}},  // by its measures below
      {"file", {}},
  };
  for (const auto& row : shape_catalogue()) {
    INFO(row.name);
    REQUIRE(exact.contains(row.name));
    VesicleParameters v;
    v.shape = row.name;
    v.order = order;
    v.axis = Vec3::UnitZ();
    for (const std::string_view key : row.keys) {
      if (key == "reduced_volume") v.reduced_volume = row.name == "biconcave" ? 0.65 : 0.85;
      if (key == "axes") v.axes = Vec3(2, 1, 0.5);
      if (key == "coefficients") v.coefficients = {{2, 0, 0.2}};
      if (key == "file") v.file = (folder.path() / "shape.txt").string();
    }
    if (row.name == "file") v.axis.reset();
    Coefficients x = initial_position(v);
    if (row.name == "harmonics") {  // undo the scaling to 4 pi: the mean radius is 1
      const Basis fine(order, 40);
      const Matrix points = fine.synthesize(x).values;
      double mean = 0;
      for (Eigen::Index k = 0; k < points.rows(); ++k) mean += fine.weights()[k] * points.row(k).norm() / (4 * pi);
      x.values /= mean;
    }
    const Basis basis(order, 20);
    const Matrix points = basis.synthesize(x).values;
    if (const Equation& equation = exact.at(row.name)) {
      double worst = 0;
      for (Eigen::Index k = 0; k < points.rows(); ++k)
        worst = std::max(worst, std::abs(equation(points.row(k).transpose())));
      CHECK(worst < 1e-4);  // a surface of degree 12 holds the harmonic one to this, the others exactly
    } else if (row.name == "file") {
      CHECK((x.values - table.values).norm() < 1e-14);
    } else {
      const Measures m = measures(geometry(Basis(order, 40), x));
      CHECK(m.area == Approx(4 * pi).epsilon(1e-6));
      CHECK(reduced_volume(m.area, m.volume) == Approx(0.65).epsilon(1e-6));
      // A disc that is thinner in the middle than further out.
      const auto height = [&](double theta) { return sample_points(x, unit_vector(theta, 0).transpose())(0, 2); };
      CHECK(height(0.01) < height(0.8));
    }
  }
}
