// Cost of the parts of a step and of the whole. The limits: a step of one vesicle with viscosity contrast 10 takes at
// most 5 ms at order 8 and 80 ms at order 16, on one core.
#include "sim/core/parallel.h"
#include "sim/suspension/placements.h"
#include "tests/bench/ceilings.h"
#include "tests/sim/surfaces.h"

#include <benchmark/benchmark.h>

#include <fftw3.h>
#include <fmt/format.h>
#include <sys/resource.h>

namespace {

using namespace sim;

constexpr auto unit = benchmark::kMillisecond;

VesicleParameters prolate(int order, double contrast) { return test::vesicle("prolate", 0.85, order, contrast); }

/// S alone, or S and D, four targets at once or as many as the processor can.
void assembly(benchmark::State& state, bool with_double, LaneCount most) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    const LayerPotentials layers(p, 0, most);
    const Coefficients x = initial_position(prolate(p, 1));
    for (auto _ : state) benchmark::DoNotOptimize(layers.assemble(x, with_double));
    bench::against_ceiling(state, bench::assembly_operations(p, with_double), 0, most);
  });
}

/// One product with S: 3 fields; its six blocks are read.
void apply(benchmark::State& state) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    const Coefficients x = initial_position(prolate(p, 1));
    const LayerMatrices m = LayerPotentials(p).assemble(x, false);
    for (auto _ : state) benchmark::DoNotOptimize(m.single.apply(x));
    const double numbers = double(m.single.values.size());
    bench::against_ceiling(state, 3 * numbers, sizeof(double) * numbers);
  });
}

/// Value and all derivatives of 3 fields of degree p on the 2p-grid.
void synthesis(benchmark::State& state) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    const Basis basis(p, 2 * p);
    const Coefficients x = test::smooth_field(p, p, 3, 1);
    for (auto _ : state) benchmark::DoNotOptimize(basis.second(x));
    bench::against_ceiling(state, bench::transform_operations(p, basis.latitudes(), 3, 3, 6));
  });
}

void analysis(benchmark::State& state) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    const Basis basis(p, 2 * p);
    const Matrix samples = basis.synthesize(test::smooth_field(p, p, 3, 1)).values;
    for (auto _ : state) benchmark::DoNotOptimize(basis.analyze(samples));
    bench::against_ceiling(state, bench::transform_operations(p, basis.latitudes(), 3, 1, 1));
  });
}

/// The longitude half of a synthesis of one field of degree p on the 2p-grid, as a dense product ...
void fourier_dense(benchmark::State& state) {
  const int p = int(state.range(0)), nlat = 2 * p + 1, nlon = 4 * p + 2;
  const Matrix spectrum = Matrix::Random(nlat, 2 * p + 1), table = Matrix::Random(2 * p + 1, nlon);
  Matrix points(nlat, nlon);
  for (auto _ : state) {
    points.noalias() = spectrum * table;
    benchmark::DoNotOptimize(points.data());
  }
}

/// ... and as FFTW's real transforms, with the copy into its order of coefficients.
void fourier_fftw(benchmark::State& state) {
  const int p = int(state.range(0)), nlat = 2 * p + 1, nlon = 4 * p + 2;
  const Matrix spectrum = Matrix::Random(nlat, 2 * p + 1);
  Matrix scratch(nlat, nlon), points(nlat, nlon);
  const fftw_iodim dimension{nlon, nlat, nlat}, many{nlat, 1, 1};
  const fftw_r2r_kind kind = FFTW_HC2R;
  const fftw_plan plan =
      fftw_plan_guru_r2r(1, &dimension, 1, &many, scratch.data(), points.data(), &kind, FFTW_ESTIMATE | FFTW_UNALIGNED);
  for (auto _ : state) {
    scratch.setZero();
    scratch.col(0) = spectrum.col(0);
    for (int m = 1; m <= p; ++m) {
      scratch.col(m) = 0.5 * spectrum.col(m);
      scratch.col(nlon - m) = -0.5 * spectrum.col(p + m);
    }
    fftw_execute_r2r(plan, scratch.data(), points.data());
    benchmark::DoNotOptimize(points.data());
  }
  fftw_destroy_plan(plan);
}

/// The ceilings themselves.
void ceiling(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(bench::arithmetic_ceiling());
  state.counters["GFLOPS"] = bench::arithmetic_ceiling() / 1e9;
  state.counters["widest"] = bench::arithmetic_ceiling(LaneCount::widest) / 1e9;
  for (const int size : {100, 400})
    state.counters[fmt::format("product_{}_GFLOPS", size)] = bench::product_rate(size) / 1e9;
  for (const auto& [name, kB] :
       {std::pair{"read_16kB", 16}, {"read_300kB", 300}, {"read_4MB", 4096}, {"read_64MB", 65536}})
    state.counters[fmt::format("{}_GB/s", name)] = bench::reading_ceiling(std::size_t(kB) * 1024) / 1e9;
}

/// The linear solve of a step of 0.1 from a zero guess, operators given.
void solve(benchmark::State& state) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    Plans plans;
    const Coefficients x = initial_position(prolate(p, 10));
    const Membrane m = freeze_membrane(plans, {10, 0.01, 0}, x, 3, 0);
    const std::vector flows{test::shear()};
    const Coefficients r = test::forcing(m, flows, Vec3::Zero());
    int iterations = 0;
    for (auto _ : state) iterations = solve_system(m, 0.1, r, test::at_rest(p), 1e-10).iterations;
    state.counters["iterations"] = iterations;
  });
}

/// Steps of 0.1 of a vesicle in shear, from rest on: what a run costs without its saved states.
void step(benchmark::State& state, double contrast, const char* reparametrization) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    Plans plans;
    Scene scene = test::shear_scene(prolate(p, contrast), 0.1, 1e9);
    scene.numerics.reparametrization = reparametrization;
    const Model s = make_model(scene, plans);
    Dynamics d = take_step(s, initial_dynamics(s), 0.1).value().dynamics;  // makes the plans
    double iterations = 0, relabelled = 0;
    for (auto _ : state) {
      Step next = take_step(s, d, 0.1).value();
      iterations += next.record.iterations;
      relabelled += next.record.vesicles[0].relabelled;
      d = std::move(next.dynamics);
    }
    state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
    state.counters["relabelled"] = benchmark::Counter(relabelled, benchmark::Counter::kAvgIterations);
  });
}

/// Velocity and tension of a state to be saved.
void evaluation(benchmark::State& state) {
  with_threads(1, [&] {
    const int p = int(state.range(0));
    Plans plans;
    const Scene scene = test::shear_scene(prolate(p, 10), 0.1, 1e9);
    const Model s = make_model(scene, plans);
    const Dynamics d = test::advanced(s, initial_dynamics(s), 0.1, 2);
    for (auto _ : state) benchmark::DoNotOptimize(evaluate(s, d).value());
  });
}

/// The kernel alone, single and double layer: sources and targets of one vesicle at p = 8, all in the first cache.
void direct_sum(benchmark::State& state, LaneCount most) {
  const Eigen::Index count = 200;
  Sources s;
  s.points = Matrix::Random(count, 3);
  s.normals = Matrix::Random(count, 3);
  s.area = Vector::Ones(count);
  SourceDensities densities{Matrix::Random(count, 3), {}};
  if (state.range(0)) densities.dual = Matrix::Random(count, 3);
  const Matrix targets = (Matrix::Random(count, 3).array() + 5).matrix();
  Matrix velocity = Matrix::Zero(count, 3);
  for (auto _ : state) add_direct_sum(s, densities, targets, velocity, most);
  bench::against_ceiling(state, bench::pair_operations(state.range(0) != 0) * double(count * count), 0, most);
  state.counters["pairs"] = benchmark::Counter(double(count * count), benchmark::Counter::kIsIterationInvariantRate);
}

/// Vesicles on a lattice with some disorder, at a volume fraction of 0.06.
Scene suspension_scene(int count, const char* method) {
  Scene scene = test::shear_scene(prolate(8, 1), 0.1, 1, "globally-implicit");
  scene.vesicles[0].reduced_volume = 0.9;
  scene.numerics.gmres_tolerance = 1e-4;
  scene.numerics.far_field = method;
  PlacementParameters lattice;
  lattice.count = count;
  lattice.volume_fraction = 0.06;
  lattice.jitter = 0.1;
  scene.placements.push_back(lattice);
  return placed(scene);
}

/// One product with the interactions of all vesicles, far, fine and near; on all processors.
void suspension_product(benchmark::State& state, const char* method) {
  Plans plans;
  const Scene scene = suspension_scene(int(state.range(0)), method);
  const Model s = make_model(scene, plans);
  const Dynamics d = initial_dynamics(s);
  std::vector<Coefficients> x;
  std::vector<Densities> densities;
  for (const VesicleDynamics& v : d.vesicles) {
    x.push_back(v.position);
    densities.push_back({v.position, v.position});
  }
  InteractionOptions options;
  options.far = {method, 1e-4};
  const Interaction w = plan_interaction(plans, x, s.materials, options);
  double pairs = w.fast ? w.fast->sum.pairs.pairs() : 0;
  for (const TargetGroup& group : w.far.groups)
    for (std::size_t j = 0; j < x.size(); ++j)
      if (!w.fast && int(j) != group.surface)
        pairs += double(group.points.rows()) * double((*w.far.sources)[j].area.size());
  for (const PairPlan& pair : w.pairs)
    if (!w.fast)
      pairs += double(pair.fine.size()) *
               (double(w.sources[pair.source].area.size()) - double((*w.far.sources)[pair.source].area.size()));
  for (auto _ : state) benchmark::DoNotOptimize(induced_velocity(w, densities));
  state.counters["pairs"] = benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate);
}

/// One step of backward Euler of all of them, and the most memory the process has held so far.
void suspension_step(benchmark::State& state, const char* method) {
  Plans plans;
  const Scene scene = suspension_scene(int(state.range(0)), method);
  const Model s = make_model(scene, plans);
  const Dynamics d = initial_dynamics(s);
  int iterations = 0;
  for (auto _ : state) iterations = take_step(s, d, 0.1).value().record.iterations;
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  state.counters["iterations"] = iterations;
  state.counters["peak_MB"] = double(used.ru_maxrss) / 1024;
}

}  // namespace

#define ORDERS DenseRange(8, 16, 4)->Arg(24)->Unit(unit)
BENCHMARK(ceiling)->Iterations(1);
BENCHMARK_CAPTURE(assembly, S, false, LaneCount::widest)->ORDERS;
BENCHMARK_CAPTURE(assembly, S_and_D, true, LaneCount::widest)->ORDERS;
BENCHMARK_CAPTURE(assembly, S_four_lanes, false, LaneCount::four)->ORDERS;
BENCHMARK_CAPTURE(assembly, S_and_D_four_lanes, true, LaneCount::four)->ORDERS;
BENCHMARK(apply)->ORDERS;
BENCHMARK(synthesis)->ORDERS;
BENCHMARK(analysis)->ORDERS;
BENCHMARK(fourier_dense)->DenseRange(8, 64, 8)->Unit(benchmark::kMicrosecond);
BENCHMARK(fourier_fftw)->DenseRange(8, 64, 8)->Unit(benchmark::kMicrosecond);
BENCHMARK(solve)->ORDERS;
// 100 steps are three quarters of a half turn. Without reparametrization: the step itself.
#define HUNDRED_STEPS Arg(8)->Arg(16)->Iterations(100)->Unit(unit)
BENCHMARK_CAPTURE(step, contrast_1, 1.0, "off")->HUNDRED_STEPS;
BENCHMARK_CAPTURE(step, contrast_10, 10.0, "off")->HUNDRED_STEPS;
BENCHMARK_CAPTURE(step, contrast_1_with_reparametrization, 1.0, "auto")->HUNDRED_STEPS;
BENCHMARK_CAPTURE(step, contrast_10_with_reparametrization, 10.0, "auto")->HUNDRED_STEPS;
BENCHMARK_CAPTURE(direct_sum, widest, LaneCount::widest)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(direct_sum, four_lanes, LaneCount::four)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
#define MANY Arg(8)->Arg(64)->Arg(256)->Iterations(1)->UseRealTime()->MeasureProcessCPUTime()->Unit(unit)
BENCHMARK_CAPTURE(suspension_product, direct, "direct")->MANY;
BENCHMARK_CAPTURE(suspension_product, fast, "fast")->Arg(1000)->MANY;
BENCHMARK_CAPTURE(suspension_step, direct, "direct")->MANY;
BENCHMARK_CAPTURE(suspension_step, fast, "fast")->Arg(1000)->MANY;
BENCHMARK(evaluation)->Arg(8)->Arg(16)->Unit(unit);

BENCHMARK_MAIN();
