#include "scene_text.h"

#include "scene_file.h"
#include "scene_values.h"

#include <fmt/format.h>

#include <cmath>

namespace app {

std::string toml_value(bool value) { return value ? "true" : "false"; }
std::string toml_value(int value) { return std::to_string(value); }
std::string toml_value(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string toml_value(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') text += '\\', text += c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) text += fmt::format("\\u{:04x}", c);
    else text += c;
  }
  return text + '"';
}
std::string toml_value(const std::array<double, 3>& value) {
  return fmt::format("[{}, {}, {}]", toml_value(value[0]), toml_value(value[1]), toml_value(value[2]));
}
std::string toml_value(const sim::Vec3& value) { return toml_value(std::array{value[0], value[1], value[2]}); }

namespace {

template <class T> std::string kind_of(std::string_view, const T&) { return {}; }
std::string kind_of(std::string_view, const sim::FlowParameters& p) { return p.kind; }
std::string kind_of(std::string_view, const sim::VesicleParameters& p) { return p.shape; }
template <class T> std::string factor_of(const T&) { return {}; }
std::string factor_of(const sim::FlowParameters& p) { return p.time_factor; }

struct Writer {
  std::string text;

  template <class T>
  void line(const sim::Parameter& parameter, const T& value) {
    text += fmt::format("{} = {}\n", parameter.name, toml_value(value));
  }
  void line(const sim::Parameter& parameter, const int& value) {
    const bool automatic = parameter.zero_is_auto && value == 0;
    text += fmt::format("{} = {}\n", parameter.name, automatic ? "\"auto\"" : toml_value(value));
  }
  template <class T>
  void line(const sim::Parameter& parameter, const std::optional<T>& value) {
    if (value) line(parameter, *value);
    else if (parameter.refused.empty()) text += fmt::format("# {}: {}\n", parameter.name, parameter.when_absent);
  }
  template <class P>
  void table(const sim::Section& section, const P& parameters) {
    visit(parameters, [&](const sim::Parameter& parameter, const auto& value) {
      if (key_applies(section.name, parameter.name, kind_of(section.name, parameters), factor_of(parameters)))
        line(parameter, value);
    });
  }
  template <class P>
  void operator()(const sim::Section& section, const P& parameters) {
    text += fmt::format("\n[{}]\n", section.name);
    table(section, parameters);
  }
  template <class P>
  void operator()(const sim::Section& section, const std::vector<P>& list) {
    for (const P& parameters : list) {
      text += fmt::format("\n[[{}]]\n", section.name);
      table(section, parameters);
    }
  }
};

}  // namespace

std::string write_scene(const Settings& settings) {
  Writer writer{"title = " + toml_value(settings.scene.title) + "\n"};
  visit_sections(settings, writer);
  return writer.text;
}

std::string write_scene(const sim::Scene& scene) {
  Writer writer{"title = " + toml_value(scene.title) + "\n"};
  sim::visit_sections(scene, writer);
  return writer.text;
}

std::string physics_hash(const sim::Scene& scene) {
  sim::Scene same = scene;
  same.title.clear();
  for (sim::VesicleParameters& v : same.vesicles) v.file.clear();  // its checksum counts, not where it lies
  same.numerics.threads = 0;
  return checksum(write_scene(same));
}

std::string picture_hash(const Settings& settings) {
  Settings same = settings;
  same.scene.numerics.threads = 0;
  same.figures.clear();
  same.movie.frame_rate = 30;  // of the video, not of a frame; and so on
  same.movie.format = render::MovieParameters{}.format;
  same.movie.poster.reset();
  return checksum(write_scene(same));
}

}  // namespace app
