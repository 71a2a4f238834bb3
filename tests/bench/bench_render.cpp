// Cost of one frame. The limit: a 1080p frame of one vesicle in under 0.3 s of processor time.
#include "render/draw.h"

#include "tests/render/surfaces.h"

#include <benchmark/benchmark.h>

#include <filesystem>

namespace {

render::Frame frame(int width, int height, const char* style) {
  render::ViewParameters view;
  view.size = {width, height};
  view.style = style;
  const sim::State state = surfaces::state_of({surfaces::ellipsoid({0.82, 0.82, 1.5}, surfaces::turn(66, {0, 1, 0}))});
  render::Frame f = surfaces::frame_of(state, view);
  const render::StateSummary summary = render::summarize(state);
  f.arrows.points = render::arrow_points(render::frame_trajectory(std::span(&summary, 1), view), summary.centroid);
  f.arrows.velocities = sim::Matrix::Zero(f.arrows.points.rows(), 3);
  f.arrows.velocities.col(0) = f.arrows.points.col(2);
  f.captions = {"γ̇t = 12.50", "Ca = 2.0   λ = 1.0   ν = 0.90"};
  return f;
}

void draw(benchmark::State& state, int width, int height, const char* style) {
  render::Renderer renderer(render::parse_gl_choice("software"));
  const render::Frame f = frame(width, height, style);
  benchmark::DoNotOptimize(render::draw_frame(renderer, f));  // compiles the shaders
  for (auto _ : state) benchmark::DoNotOptimize(render::draw_frame(renderer, f));
}

void mesh(benchmark::State& state, int order) {
  const auto plan = std::make_shared<const render::MeshPlan>();
  const sim::VesicleState vesicle =
      surfaces::vesicle([](const sim::Vec3& s) { return s; }, [](const sim::Vec3& s) { return s; }, order);
  for (auto _ : state) benchmark::DoNotOptimize(render::make_mesh(plan, vesicle));
}

void png(benchmark::State& state, int level) {
  render::Renderer renderer(render::parse_gl_choice("software"));
  const render::Image image = render::draw_frame(renderer, frame(1920, 1080, "opaque"));
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "tanktread_bench.png";
  for (auto _ : state) render::write_png(path, image, {}, level);
  std::filesystem::remove(path);
}

}  // namespace

// Mesa draws in threads of its own: processor time of the process is what counts.
BENCHMARK_CAPTURE(draw, opaque_1080p, 1920, 1080, "opaque")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(draw, outline_1080p, 1920, 1080, "outline")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(draw, opaque_320x240, 320, 240, "opaque")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(mesh, order_8, 8)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mesh, order_24, 24)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(png, level_6, 6)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
