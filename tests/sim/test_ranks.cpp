// Several ranks, here threads of one process: what each has after a collective call.
#include "sim/core/divided.h"
#include "sim/core/parallel.h"
#include "sim/fast/fast_sum.h"
#include "sim/stepping/stepper.h"
#include "surfaces.h"
#include "tests/support/catch.h"

#include <barrier>
#include <random>
#include <string>
#include <thread>

using namespace sim;

namespace {

/// f(ranks) on so many threads at once, each a rank of its own.
template <class F>
void as_ranks(int count, F&& f) {
  std::barrier meeting(count);
  std::vector<std::vector<double>> table(static_cast<std::size_t>(count));
  std::vector<std::vector<std::vector<double>>> letters(static_cast<std::size_t>(count));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank)
    threads.emplace_back([&, rank] {
      Ranks ranks;
      ranks.rank = rank;
      ranks.count = count;
      ranks.gathered = [&, rank](std::span<const double> mine) {
        table[std::size_t(rank)].assign(mine.begin(), mine.end());
        meeting.arrive_and_wait();
        auto all = table;
        meeting.arrive_and_wait();
        return all;
      };
      ranks.exchanged = [&, rank](std::span<const std::vector<double>> given) {
        letters[std::size_t(rank)].assign(given.begin(), given.end());
        meeting.arrive_and_wait();
        std::vector<std::vector<double>> got;
        for (const auto& from : letters) got.push_back(from[std::size_t(rank)]);
        meeting.arrive_and_wait();
        return got;
      };
      with_threads(1, [&] { f(ranks); });
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace

TEST_CASE("after a divided loop every rank has every item, each computed by one rank") {
  constexpr int count = 3, n = 10;
  std::vector<std::vector<Coefficients>> results(count, std::vector<Coefficients>(n));
  std::vector<int> computed(n);
  as_ranks(count, [&](const Ranks& ranks) {
    std::vector<Coefficients>& mine = results[std::size_t(ranks.rank)];
    divided_for(
        divided(ranks, n), n,
        [&](int k) {
          ++computed[std::size_t(k)];
          mine[std::size_t(k)] = test::smooth_field(k, k, 3, unsigned(k));
        },
        [&](Parcel& parcel, int k) { parcel(mine[std::size_t(k)]); });
  });
  CHECK(computed == std::vector<int>(n, 1));
  for (const auto& one : results)
    for (int k = 0; k < n; ++k) {
      const Coefficients expected = test::smooth_field(k, k, 3, unsigned(k));
      CHECK(one[std::size_t(k)].order == k);
      CHECK(one[std::size_t(k)].values == expected.values);
    }
}

TEST_CASE("a shape that one rank refuses is refused by all with the sentence of the first such item") {
  constexpr int count = 4, n = 9;
  std::vector<std::string> said(count);
  as_ranks(count, [&](const Ranks& ranks) {
    try {
      divided_for(divided(ranks, n), n, [](int k) {
        if (k == 3 || k == 7) throw std::domain_error("item " + std::to_string(k));
      });
    } catch (const std::domain_error& error) {
      said[std::size_t(ranks.rank)] = error.what();
    }
  });
  CHECK(said == std::vector<std::string>(count, "item 3"));
}

TEST_CASE("ranks get boxes of about the same weight, whatever their number") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int n = 400;
  std::vector<Vec3> places;
  std::vector<double> weights;
  double total = 0;
  for (int k = 0; k < n; ++k) {
    places.emplace_back(10 * uniform(random), 3 * uniform(random), uniform(random));
    weights.push_back(k % 10 == 0 ? 5 : 1);
    total += weights.back();
  }
  for (const int count : {2, 3, 7, 16}) {
    Ranks ranks;
    ranks.count = count;
    const Division division = divided(ranks, places, weights);
    std::vector<double> load(static_cast<std::size_t>(count));
    for (int k = 0; k < n; ++k) load.at(std::size_t(division.owner[std::size_t(k)])) += weights[std::size_t(k)];
    // Each of at most four cuts may miss by half of the heaviest item.
    for (const double one : load) CHECK(std::abs(one - total / count) <= 4 * 2.5);
  }
  Ranks two;
  two.count = 2;
  const Division halves = divided(two, places, weights);
  double left = 0, right = 10;
  for (int k = 0; k < n; ++k) {
    const double x = places[std::size_t(k)][0];
    if (halves.owner[std::size_t(k)] == 0)
      left = std::max(left, x);
    else
      right = std::min(right, x);
  }
  CHECK(left <= right);  // cut across the longest side
}

TEST_CASE("more ranks than items leave some without work, and nothing is lost") {
  std::vector<std::vector<double>> results(5, std::vector<double>(2));
  as_ranks(5, [&](const Ranks& ranks) {
    std::vector<double>& mine = results[std::size_t(ranks.rank)];
    const std::vector<Vec3> places{Vec3(0, 0, 0), Vec3(0, 0, 0)};
    const std::vector<double> weights{1, 1};
    divided_for(
        divided(ranks, places, weights), 2, [&](int k) { mine[std::size_t(k)] = k + 1; },
        [&](Parcel& parcel, int k) { parcel(mine[std::size_t(k)]); });
  });
  CHECK(results == std::vector<std::vector<double>>(5, {1, 2}));
}

TEST_CASE("a step taken by two, three or 23 ranks is the step of one, bit for bit, on each of them") {
  Scene scene;
  scene.flows = {{}};
  scene.flows[0].kind = "shear";
  scene.time.end = 1;
  for (int k = 0; k < 3; ++k) {
    VesicleParameters v;
    v.shape = "prolate";
    v.reduced_volume = 0.9;
    v.order = 4;
    v.viscosity_contrast = 2;
    v.center = Vec3(3.4 * k, 0, 0.3 * k);
    scene.vesicles.push_back(v);
  }
  const auto stepped = [&](const Ranks& ranks) {
    Plans plans;
    const Model s = make_model(scene, plans, ranks);
    Dynamics d = initial_dynamics(s);
    for (int k = 0; k < 3; ++k) d = take_step(s, d, 0.02).value().dynamics;
    // What was learned stays with the rank of its vesicle: here all for each in turn.
    std::vector<double> numbers;
    for (int rank = 0; rank < ranks.count; ++rank) {
      Dynamics whole = d;
      whole.learned =
          delivered(d.learned, d.keepers, ranks.count == 1 ? Division{} : Division{&ranks, std::vector<int>(3, rank)});
      if (rank == ranks.rank) numbers = serialised(whole);
    }
    return numbers;
  };
  // Direct sums in free space, fast ones in a cell.
  for (const auto& cell : {std::optional<Vec3>(), std::optional<Vec3>(Vec3(10.4, 5, 6))}) {
    scene.cell.size = cell;
    std::vector<double> expected;
    as_ranks(1, [&](const Ranks& ranks) { expected = stepped(ranks); });
    for (const int count : {2, 3, 23}) {  // of 23, twenty have no unknowns at all
      std::vector<std::vector<double>> found(static_cast<std::size_t>(count));
      as_ranks(count, [&](const Ranks& ranks) { found[std::size_t(ranks.rank)] = stepped(ranks); });
      for (const auto& one : found) {
        const bool same = one == expected;
        CHECK(same);
      }
    }
  }
}

TEST_CASE("what the first rank continues from, all continue from, and a record is as long as was foreseen") {
  Scene scene;
  scene.flows = {{}};
  scene.flows[0].kind = "shear";
  scene.time.end = 1;
  scene.time.step = 0.02;
  scene.time.scheme = "bdf2";
  for (int k = 0; k < 3; ++k) {
    VesicleParameters v;
    v.shape = "prolate";
    v.order = 4 + k;
    v.reduced_volume = 0.9;
    v.center = Vec3(3.4 * k, 0, 0);
    scene.vesicles.push_back(v);
  }
  Plans plans;
  const Model s = make_model(scene, plans);
  const Dynamics start = initial_dynamics(s);
  Dynamics d = start;
  for (int k = 0; k < 2; ++k) d = take_step(s, d, 0.02).value().dynamics;
  // As soon as two steps are behind, with all that may be learned.
  CHECK(resume_numbers(start, 2) == resume_numbers(d, 2));
  CHECK(serialised(d).size() < resume_numbers(d, 2));
  Dynamics full = d;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::MatrixXf all = Eigen::MatrixXf::Ones(unknowns(d.vesicles[k].position.order), directions_kept(3));
    full.learned[k] = std::make_shared<const Learned>(Learned{all, all});
  }
  CHECK(serialised(full).size() == resume_numbers(d, 2));
  constexpr int count = 3;
  std::vector<std::vector<double>> found(count);
  const std::vector<double> next = serialised(take_step(s, d, 0.02).value().dynamics);
  as_ranks(count, [&](const Ranks& ranks) {
    Plans own;
    const Model model = make_model(scene, own, ranks);
    Dynamics mine = ranks.first() ? d : Dynamics{};
    from_first(ranks, mine);
    mine = take_step(model, mine, 0.02).value().dynamics;
    const Division to_all[] = {{&ranks, {0, 0, 0}}, {&ranks, {1, 1, 1}}, {&ranks, {2, 2, 2}}};
    for (int rank = 0; rank < count; ++rank) {
      Dynamics whole = mine;
      whole.learned = delivered(mine.learned, mine.keepers, to_all[rank]);
      if (rank == ranks.rank) found[std::size_t(rank)] = serialised(whole);
    }
  });
  for (const auto& one : found) {
    const bool same = one == next;
    CHECK(same);
  }
}

TEST_CASE("ranks that divide the mesh of a fast sum get the bits of one that has it whole") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int bodies_count = 7, points = 30;
  std::vector<FastBody> bodies;
  std::vector<FastGroup> groups;
  std::vector<FastStrengths> strengths;
  const auto numbers = [&](Eigen::Index rows) {
    return Matrix(Matrix::NullaryExpr(rows, points, [&] { return uniform(random); }));
  };
  for (int b = 0; b < bodies_count; ++b) {
    bodies.push_back({Points(3 * numbers(3)), {}, 0});
    groups.push_back({bodies.back().coarse, b});
    strengths.push_back({numbers(3), numbers(6)});
  }
  const std::vector<FastStrengths> none(bodies_count);
  Eigen::Matrix3d sheared = Eigen::Vector3d(6, 6, 6).asDiagonal();
  sheared(0, 2) = 1.3;
  for (const auto& cell : {std::optional<Eigen::Matrix3d>(), std::optional<Eigen::Matrix3d>(sheared)})
    for (const bool dual : {false, true}) {
      FastSetting setting = fast_setting(1e-4, dual);
      setting.cutoff = 2;
      setting.cell = cell;
      std::vector<FastStrengths> given = strengths;
      for (FastStrengths& s : given)
        if (!dual) s.dual.resize(6, 0);
      FastParts parts;
      const auto whole = fast_velocity(plan_fast_sum(setting, bodies, groups, {}, dual, parts), given, none);
      // 23 ranks: more than some slabs have planes for a window.
      for (const int count : {2, 3, 23}) {
        std::vector<Points> found(bodies_count);
        as_ranks(count, [&](const Ranks& ranks) {
          std::vector<FastGroup> mine = groups;
          for (int g = 0; g < bodies_count; ++g) {
            mine[std::size_t(g)].wanted = g % count == ranks.rank;
          }
          FastParts own;
          const auto velocity = fast_velocity(plan_fast_sum(setting, bodies, mine, {}, dual, own, ranks), given, none);
          for (int g = ranks.rank; g < bodies_count; g += count) found[std::size_t(g)] = velocity[std::size_t(g)];
        });
        INFO(count << " ranks, " << (cell ? "a cell" : "free space") << (dual ? ", both layers" : ""));
        for (int g = 0; g < bodies_count; ++g)
          CHECK((found[std::size_t(g)].array() == whole[std::size_t(g)].array()).all());
      }
    }
}

TEST_CASE("ranks that have only the sources they need get the bits of one that has all") {
  // Small bodies in a long row: whose targets are at one end needs nothing of the other.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int bodies_count = 40, points = 20, count = 5;
  const auto numbers = [&](Eigen::Index rows) {
    return Matrix(Matrix::NullaryExpr(rows, points, [&] { return uniform(random); }));
  };
  const auto box_of = [](const Points& p) { return Box{p.rowwise().minCoeff(), p.rowwise().maxCoeff()}; };
  std::vector<FastBody> bodies;
  std::vector<FastGroup> groups;
  std::vector<FastStrengths> strengths;
  std::vector<Vec3> places;
  for (int b = 0; b < bodies_count; ++b) {
    places.emplace_back(uniform(random), uniform(random), 2.5 * b);
    bodies.push_back({Points(numbers(3).colwise() + places.back()), {}, 0});
    groups.push_back({bodies.back().coarse, b});
    strengths.push_back({numbers(3), numbers(6)});
  }
  const std::vector<FastStrengths> none(bodies_count);
  const Eigen::Matrix3d sides = Eigen::Vector3d(5, 5, 2.5 * bodies_count).asDiagonal();
  for (const auto& cell : {std::optional<Eigen::Matrix3d>(), std::optional<Eigen::Matrix3d>(sides)}) {
    FastSetting setting = fast_setting(1e-4, true);
    setting.cutoff = 2;
    setting.cell = cell;
    FastParts parts;
    const auto whole = fast_velocity(plan_fast_sum(setting, bodies, groups, {}, true, parts), strengths, none);
    std::vector<Points> found(bodies_count);
    std::vector<int> needed(count);
    as_ranks(count, [&](const Ranks& ranks) {
      Division division = divided(ranks, places, std::vector<double>(bodies_count, 1.0));
      for (int& owner : division.owner) owner = (owner + 1) % count;  // so that nobody's targets lie in its slab
      FastOutlines outlines;
      std::vector<char> wanted;
      for (int b = 0; b < bodies_count; ++b) {
        outlines.coarse.push_back(box_of(bodies[std::size_t(b)].coarse));
        wanted.push_back(division.mine(b));
      }
      outlines.both = outlines.groups = outlines.coarse;
      FastParts own;
      const FastNeeds needs = needs_of(setting, outlines, wanted, own, ranks);
      std::vector<FastBody> here = bodies;
      std::vector<FastGroup> mine = groups;
      std::vector<FastStrengths> given = strengths;
      for (std::size_t b = 0; b < bodies_count; ++b) {
        here[b].owner = division.owner[b];
        mine[b].wanted = wanted[b] != 0;
        if (!wanted[b]) mine[b].points.resize(3, 0);
        if (wanted[b] || needs.mesh[b] || needs.pairs[b]) {
          ++needed[std::size_t(ranks.rank)];
          continue;
        }
        here[b].coarse.resize(3, 0);
        given[b] = {};
      }
      const auto velocity = fast_velocity(plan_fast_sum(setting, here, mine, {}, true, own, ranks), given, none);
      for (std::size_t b = 0; b < bodies_count; ++b)
        if (wanted[b]) found[b] = velocity[b];
    });
    INFO((cell ? "a cell" : "free space"));
    for (const int of_rank : needed) CHECK(of_rank <= bodies_count * 5 / 8);  // two fifths, and a few beside them
    for (std::size_t b = 0; b < bodies_count; ++b) CHECK((found[b].array() == whole[b].array()).all());
  }
}
