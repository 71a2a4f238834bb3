// Placements of many sizes.
#include "sim/membrane/cell.h"
#include "sim/suspension/copies.h"
#include "sim/suspension/gap.h"
#include "sim/suspension/placements.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <numeric>

using namespace sim;

namespace {

double mean(const std::vector<double>& all) {
  return std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
}

double spread(const std::vector<double>& all) {
  const double middle = mean(all);
  double sum = 0;
  for (const double x : all) sum += (x - middle) * (x - middle);
  return std::sqrt(sum / double(all.size()));
}

AreaVolume size_of(const VesicleParameters& v) {
  const Coefficients x = initial_position(v);
  return area_volume(Basis(x.order, 2 * x.order + 8), x);
}

}  // namespace

TEST_CASE("drawn sizes are log-normal with the mean and the spread that are asked for") {
  for (const double wanted : {0.05, 0.3, 1.0}) {
    INFO(wanted);
    const double sigma = std::sqrt(std::log1p(wanted * wanted));
    const std::vector<double> many = drawn_sizes(20000, wanted, 5);
    // One is drawn in each of equally likely ranges: but for the tails, sums are those of the distribution.
    CHECK(mean(many) == Approx(1).epsilon(2e-3));
    CHECK(spread(many) == Approx(wanted).epsilon(0.03));
    std::vector<double> logarithms;
    for (const double size : many) logarithms.push_back(std::log(size));
    CHECK(mean(logarithms) == Approx(-sigma * sigma / 2).margin(1e-3 * sigma));
    CHECK(spread(logarithms) == Approx(sigma).epsilon(2e-3));
    for (const auto& [z, share] : {std::pair(-1.0, 0.158655), {0.0, 0.5}, {1.5, 0.933193}}) {
      const double limit = z * sigma - sigma * sigma / 2;
      const auto below = std::count_if(logarithms.begin(), logarithms.end(), [limit](double x) { return x < limit; });
      CHECK(double(below) / double(many.size()) == Approx(share).margin(1e-4));
    }
    // Ones of many seeds are independent: four standard errors of mean and spread (kurtosis below that of the
    // logarithm).
    std::vector<double> one, first_of_ten;
    for (int seed = 0; seed < 4000; ++seed) {
      one.push_back(std::log(drawn_sizes(1, wanted, seed)[0]));
      first_of_ten.push_back(std::log(drawn_sizes(10, wanted, seed)[0]));
    }
    for (const std::vector<double>& each : {one, first_of_ten}) {
      CHECK(mean(each) == Approx(-sigma * sigma / 2).margin(4 * sigma / std::sqrt(4000.0)));
      CHECK(spread(each) == Approx(sigma).epsilon(4 / std::sqrt(8000.0)));
    }
  }
  CHECK(drawn_sizes(3, 0, 1) == std::vector<double>{1, 1, 1});
  CHECK(drawn_sizes(9, 0.2, 4) == drawn_sizes(9, 0.2, 4));
  CHECK(drawn_sizes(9, 0.2, 4) != drawn_sizes(9, 0.2, 5));
}

TEST_CASE(
    "a mix of sizes is placed at a volume fraction of 0.4, apart, each of the same shape, the same from one seed") {
  for (const auto& [shape, orientation, wanted] : {std::tuple("prolate", "random", 0.3),
                                                   {"prolate", "as-given", 0.3},
                                                   {"ellipsoid", "random", 0.2},
                                                   {"sphere", "random", 0.7}}) {
    INFO(shape << ", " << orientation << ", " << wanted);
    VesicleParameters v = test::vesicle(shape, 0.9, 6);
    if (shape == std::string("sphere")) v.reduced_volume.reset();
    if (shape == std::string("ellipsoid")) {
      v.reduced_volume.reset();
      v.axes = Vec3(1.3, 1, 0.9);
    }
    v.bending_modulus = 0.07;
    PlacementParameters p;
    p.kind = "box";
    p.orientation = orientation;
    p.count = 40;
    p.size_spread = wanted;
    const AreaVolume original = size_of(v);
    const double own_radius = std::sqrt(original.area / (4 * test::pi));
    double volume = 0;
    for (const double size : drawn_sizes(p.count, wanted, p.seed)) volume += original.volume * size * size * size;
    const double side = std::cbrt(volume / 0.4);
    Scene s = test::shear_scene(v, 0.1, 1);
    s.cell.size = Vec3(side, side, side);
    s.placements = {p};
    const Scene full = placed(s), again = placed(s);
    s.placements[0].seed = 2;
    const Scene other = placed(s);
    REQUIRE(int(full.vesicles.size()) == p.count);
    std::vector<double> radii;
    volume = 0;
    for (std::size_t k = 0; k < full.vesicles.size(); ++k) {
      const VesicleParameters& one = full.vesicles[k];
      const AreaVolume size = size_of(one);
      CHECK(reduced_volume(size.area, size.volume) == Approx(reduced_volume(original.area, original.volume)));
      CHECK(one.bending_modulus == 0.07);
      radii.push_back(std::sqrt(size.area / (4 * test::pi)) / own_radius);
      volume += size.volume;
      CHECK((one.center.cwiseAbs().array() <= side / 2).all());
      CHECK(one.center == again.vesicles[k].center);
      CHECK(*one.radius == *again.vesicles[k].radius);
      CHECK(*one.radius != *other.vesicles[k].radius);
    }
    CHECK(volume / std::pow(side, 3) == Approx(0.4));
    // Of forty, one in each fortieth of the distribution; the uppermost has a part in the spread.
    CHECK(mean(radii) == Approx(1).margin(0.1 * wanted));
    CHECK(spread(radii) == Approx(wanted).epsilon(0.25));
    CHECK(test::starting_gap(full) >= default_placement_gap * own_radius * (1 - 1e-6));
  }
}

TEST_CASE("the volume fraction of a placement of many sizes is that of the sizes that are drawn") {
  for (const std::string kind : {"lattice", "box", "tube"}) {
    INFO(kind);
    Scene s = test::shear_scene(test::vesicle("prolate", 0.9, 4), 0.1, 1);
    PlacementParameters p;
    p.kind = kind;
    p.count = 27;
    p.volume_fraction = kind == "lattice" ? 0.02 : 0.1;  // a lattice makes no room for large ones
    p.size_spread = 0.4;
    if (kind == "tube") p.radius = 4;
    p.orientation = kind == "box" ? "random" : "as-given";
    s.placements = {p};
    const Scene full = placed(s);
    std::vector<Coefficients> x;
    double volume = 0, largest = 0;
    Vec3 most = Vec3::Zero();
    for (const VesicleParameters& one : full.vesicles) {
      x.push_back(initial_position(one));
      volume += size_of(one).volume;
      largest = std::max(largest, *one.radius);
      most = most.cwiseMax(one.center.cwiseAbs());
    }
    CHECK(largest > 1.5);  // the largest of 27 is one of exp(0.385 z - 0.074), z > 1.78
    const double side = std::cbrt(volume / p.volume_fraction);
    if (kind == "lattice") CHECK(most[0] == Approx(side / 3));  // three places a side
    if (kind == "box") CHECK((most.array() <= side / 2).all());
    if (kind == "tube") {
      CHECK(most[0] <= volume / p.volume_fraction / (16 * test::pi) / 2);
      // No vesicle reaches out of the tube.
      for (const Coefficients& c : x) {
        const Matrix points = Basis(4, 12).synthesize(c).values;
        CHECK(points.rightCols(2).rowwise().norm().maxCoeff() <= 4);
      }
    }
    if (kind == "lattice") continue;  // it asks for no distance
    CHECK(test::starting_gap(full) >= default_placement_gap * (1 - 1e-6));
  }
  Scene s = test::shear_scene(test::vesicle("sphere", 1, 4), 0.1, 1);
  PlacementParameters p;
  p.count = 27;
  p.volume_fraction = 0.5;
  p.size_spread = 0.4;
  s.placements = {p};
  CHECK_THROWS_WITH(placed(s), Catch::Contains("overlap: vesicles") &&
                                   Catch::Contains("give a smaller volume_fraction or size_spread"));
  s.placements[0].size_spread = 0;
  s.cell.size = Vec3(1.5, 1.5, 1.5);  // a volume fraction of 33
  CHECK_THROWS_WITH(placed(s), Catch::Contains("on a lattice at a volume fraction of 33.5 overlap") &&
                                   Catch::Contains("give a smaller count"));
  s.cell.size.reset();
  p.kind = "tube";
  p.count = 200;
  p.size_spread = 1;
  s.placements = {p};
  CHECK_THROWS_WITH(placed(s), Catch::Contains("narrower than the largest vesicle, which reaches"));
}

TEST_CASE("a tube in a periodic cell is filled apart from all images, or refused with its radius and length") {
  Scene s = test::shear_scene(test::vesicle("prolate", 0.9, 6), 0.1, 1);
  PlacementParameters p;
  p.kind = "tube";
  p.count = 40;
  p.volume_fraction = 0.1;
  s.placements = {p};
  s.cell.size = Vec3(60, 6.2, 6.2);
  int asked = 0;
  const auto count = [&] { return ++asked < 0; };
  const Scene full = placed(s, count);
  CHECK(full.vesicles.size() == 40);
  CHECK(asked >= 40);
  // Just wide enough: what is at the wall is near the images of what is at the other.
  CHECK(test::starting_gap(full) >= default_placement_gap * (1 - 1e-6));
  s.cell.size = Vec3(10, 8, 8);  // a sixth of the length: there is no room
  asked = 0;
  CHECK_THROWS_WITH(placed(s, count), Catch::Contains("in a tube of radius 3 and length 53") &&
                                          Catch::Contains("in a cell of 10 x 8 x 8") &&
                                          Catch::Contains("give a smaller count or gap"));
  CHECK(asked == 0);
  s.cell.size = Vec3(28, 8, 8);  // half of it: the search jams
  CHECK_THROWS_WITH(placed(s, count), Catch::Contains("of 40 vesicles of radius 1 could be placed") &&
                                          Catch::Contains("in a tube of radius 3 and length 53"));
  s.cell.size.reset();
  s.placements[0].volume_fraction = 0.5;
  CHECK_THROWS_WITH(placed(s, count), Catch::Contains("in a tube of radius 3 and length 10.7") &&
                                          Catch::Contains("give a smaller volume_fraction or gap"));
}

TEST_CASE("places of many sizes scale with the vesicle, from a micrometre to a thousand kilometres") {
  Scene s = test::shear_scene(test::vesicle("prolate", 0.9, 4), 0.1, 1);
  PlacementParameters p;
  p.kind = "box";
  p.count = 30;
  p.volume_fraction = 0.4;
  p.size_spread = 0.5;
  s.placements = {p};
  const Scene usual = placed(s);
  for (const double radius : {0x1p-20, 0x1p20}) {  // powers of two: without rounding
    s.vesicles[0].radius = radius;
    const Scene scaled = placed(s);
    for (std::size_t k = 0; k < usual.vesicles.size(); ++k) {
      CHECK(scaled.vesicles[k].center / radius == usual.vesicles[k].center);
      CHECK(*scaled.vesicles[k].radius / radius == *usual.vesicles[k].radius);
    }
  }
}
