// Cost of one frame and of its parts. The limit: 220 ms of processor time for two vesicles at 1080p, opaque, from the
// saved state to the PNG file.
#include "render/draw/depth_order.h"
#include "render/draw/draw.h"
#include "render/scene/arrow_net.h"

#include "tests/render/surfaces.h"

#include <benchmark/benchmark.h>

#include <filesystem>

namespace {

sim::State pair() {
  return surfaces::state_of(
      {surfaces::disc(surfaces::turn(-35, {0, 1, 0}) * surfaces::turn(23, {1, 0, 0}), {-1.25, 0, 0.5}),
       surfaces::ellipsoid({0.82, 0.82, 1.5}, surfaces::turn(66, {0, 1, 0}), {1.25, 0, -0.5})});
}

render::Frame frame(int width, int height, const char* style) {
  render::ViewParameters view;
  view.size = {width, height};
  view.style = style;
  const sim::State state = pair();
  render::Frame f = surfaces::painted(surfaces::frame_of(state, view), state);
  f.view.colour_bar = true;
  if (std::string_view(style) != "field") f.legend.reset();
  const render::StateSummary summary = render::summarize(state);
  f.arrows.points = render::arrow_points(render::frame_trajectory(std::span(&summary, 1), view), summary.centroid);
  f.arrows.velocities = sim::Matrix::Zero(f.arrows.points.rows(), 3);
  f.arrows.velocities.col(0) = f.arrows.points.col(2);
  f.captions.time = "γ̇t = 12.50";
  f.captions.parameters = "Ca = 2.0   λ = 1.0   ν = 0.90";
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

void tracers(benchmark::State& state) {
  const render::Frame f = frame(1920, 1080, "opaque");
  for (auto _ : state)
    for (const render::Body& body : f.bodies) benchmark::DoNotOptimize(render::nearest_tracers(body.mesh));
}

void downsampling(benchmark::State& state) {
  render::Image samples(3840, 2160, 4);
  for (std::size_t k = 0; k < samples.pixels.size(); ++k)
    samples.pixels[k] = static_cast<std::uint8_t>(k * 2654435761U >> 24);
  for (auto _ : state) benchmark::DoNotOptimize(render::downsample(samples, 2, render::RowOrder::bottom_first));
}

void captions(benchmark::State& state) {
  const render::Frame f = frame(1920, 1080, "opaque");
  const render::Font font;
  render::Image image(1920, 1080, 3);
  for (auto _ : state) render::draw_captions(image, font, f);
}

void order(benchmark::State& state) {
  const render::Frame f = frame(1920, 1080, "ghost");
  for (auto _ : state) benchmark::DoNotOptimize(render::back_to_front(f.bodies, f.camera));
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
BENCHMARK_CAPTURE(draw, ghost_1080p, 1920, 1080, "ghost")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(draw, field_1080p, 1920, 1080, "field")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(draw, cutaway_1080p, 1920, 1080, "cutaway")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(draw, opaque_320x240, 320, 240, "opaque")->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(mesh, order_8, 8)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mesh, order_24, 24)->Unit(benchmark::kMillisecond);
BENCHMARK(tracers)->Unit(benchmark::kMillisecond);
BENCHMARK(downsampling)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(captions)->Unit(benchmark::kMillisecond);
BENCHMARK(order)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(png, level_6, 6)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
