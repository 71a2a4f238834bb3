#include "app/scene/scene_text.h"

#include "app/scene/scene_file.h"
#include "app/scene/scene_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

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
    if (c == '"' || c == '\\')
      text += '\\', text += c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      text += fmt::format("\\u{:04x}", c);
    else
      text += c;
  }
  // The control characters beyond ASCII, which terminals obey as well.
  for (std::size_t at = 0; (at = text.find('\xc2', at)) != std::string::npos; ++at)
    if (const auto next = at + 1 < text.size() ? static_cast<unsigned char>(text[at + 1]) : 0;
        next >= 0x80 && next < 0xa0)
      text.replace(at, 2, fmt::format("\\u{:04x}", next));
  return text + '"';
}
std::string toml_value(const std::array<double, 3>& value) {
  return fmt::format("[{}, {}, {}]", toml_value(value[0]), toml_value(value[1]), toml_value(value[2]));
}
std::string toml_value(const sim::Vec3& value) { return toml_value(std::array{value[0], value[1], value[2]}); }
std::string toml_value(const render::FieldRange& value) {
  return value.shared ? toml_value(std::string(render::range_words[0])) : toml_value(value.ends);
}

namespace {

template <class T>
std::string kind_of(std::string_view, const T&) {
  return {};
}
std::string kind_of(std::string_view, const sim::FlowParameters& p) { return p.kind; }
std::string kind_of(std::string_view, const sim::VesicleParameters& p) { return p.shape; }
template <class T>
std::string factor_of(const T&) {
  return {};
}
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
    if (value)
      line(parameter, *value);
    else if (parameter.refused.empty())
      text += fmt::format("# {}: {}\n", parameter.name, parameter.when_absent);
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

/// Keys and values of a scene, as write_scene() writes them; tables of a list carry their numbers.
struct Flattener {
  std::vector<std::pair<std::string, std::string>> lines;

  template <class P>
  void table(const std::string& name, const sim::Section& section, const P& parameters) {
    Writer writer;
    writer.table(section, parameters);
    std::string_view text = writer.text;
    while (!text.empty()) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(line.size() + 1);
      const bool absent = line.starts_with("# ");
      if (absent) line.remove_prefix(2);
      const std::string_view between = absent ? ": " : " = ";
      const std::size_t at = line.find(between);
      lines.emplace_back(fmt::format("{}.{}", name, line.substr(0, at)),
                         absent ? "none" : line.substr(at + between.size()));
    }
  }
  template <class P>
  void operator()(const sim::Section& section, const P& parameters) {
    table(std::string(section.name), section, parameters);
  }
  template <class P>
  void operator()(const sim::Section& section, const std::vector<P>& list) {
    for (std::size_t k = 0; k < list.size(); ++k) table(fmt::format("{}.{}", section.name, k), section, list[k]);
  }
};

/// What does not count for the physics has the same value everywhere.
sim::Scene bare(sim::Scene scene) {
  scene.title.clear();
  for (sim::VesicleParameters& v : scene.vesicles) v.file.clear();  // its checksum counts, not where it lies
  scene.start.from.reset();                                         // likewise, that of its state
  scene.numerics.threads = 0;
  return scene;
}

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

std::string physics_hash(const sim::Scene& scene) { return checksum(write_scene(bare(scene))); }

std::vector<SceneDifference> physics_differences(const sim::Scene& first, const sim::Scene& second) {
  Flattener a, b;
  const sim::Scene one = bare(first), two = bare(second);
  sim::visit_sections(one, a);
  sim::visit_sections(two, b);
  std::vector<SceneDifference> all;
  if (a.lines == b.lines) return all;
  const std::map<std::string, std::string> there(a.lines.begin(), a.lines.end()), here(b.lines.begin(), b.lines.end());
  const auto value = [](const auto& values, const std::string& key) {
    const auto entry = values.find(key);
    return entry == values.end() ? std::string("none") : entry->second;
  };
  for (const auto& [key, text] : a.lines)
    if (const std::string other = value(here, key); other != text) all.push_back({key, text, other});
  for (const auto& [key, text] : b.lines)
    if (text != "none" && !there.contains(key)) all.push_back({key, "none", text});
  // A list of one needs no number.
  for (SceneDifference& d : all)
    if (const std::size_t at = d.key.find(".0."); at != std::string::npos) {
      const std::string next = d.key.substr(0, at) + ".1.";
      const auto several = [&](const auto& values) {
        const auto entry = values.lower_bound(next);
        return entry != values.end() && entry->first.starts_with(next);
      };
      if (!several(there) && !several(here)) d.key.erase(at, 2);
    }
  return all;
}

bool continuable(const std::vector<SceneDifference>& differences) {
  return std::all_of(differences.begin(), differences.end(),
                     [](const SceneDifference& d) { return d.key == "time.end" || d.key == "time.save_every"; });
}

std::string text_of(const std::vector<SceneDifference>& differences) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, differences.size()); ++k) {
    const SceneDifference& d = differences[k];
    text += fmt::format("{}{} is {} there and {} here", text.empty() ? "" : ", ", d.key, d.first, d.second);
  }
  if (differences.size() > most) text += fmt::format(", and {} more keys", differences.size() - most);
  return text;
}

std::string symbol_of(const std::string& key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> symbols{{{"viscosity_contrast", "λ"},
                                                                                  {"reduced_volume", "ν"},
                                                                                  {"bending_modulus", "κ_{b}"},
                                                                                  {"density_difference", "Δρ"},
                                                                                  {"rate", "γ̇"},
                                                                                  {"radius", "R"}}};
  const std::string word = key.substr(key.rfind('.') + 1);
  for (const auto& [name, symbol] : symbols)
    if (name == word) return std::string(symbol);
  return {};
}

std::vector<std::string> distinct_names(const std::vector<sim::Scene>& scenes, const std::vector<std::string>& files) {
  constexpr std::size_t most_keys = 3;
  std::vector<std::string> names(scenes.size());
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < scenes.size(); ++k) groups[scenes[k].title].push_back(k);
  for (const auto& [title, members] : groups) {
    if (members.size() == 1) {
      names[members[0]] = title;
      continue;
    }
    std::vector<std::string> keys;                           // in the order of the scenes' tables
    std::vector<std::map<std::string, std::string>> values;  // of a member, where they are not those of the first
    std::map<std::string, std::string> firsts;
    for (const std::size_t k : members) {
      values.emplace_back();
      for (const SceneDifference& d : physics_differences(scenes[members[0]], scenes[k])) {
        if (firsts.try_emplace(d.key, d.first).second) keys.push_back(d.key);
        values.back()[d.key] = d.second;
      }
    }
    const auto value_of = [&](std::size_t m, const std::string& key) {
      const auto own = values[m].find(key);
      return own == values[m].end() ? firsts[key] : own->second;
    };
    // Keys of the times and of numerics are no name where the others tell the scenes apart.
    std::vector<std::string> of_physics;
    for (const std::string& key : keys)
      if (!key.starts_with("time.") && !key.starts_with("numerics.")) of_physics.push_back(key);
    std::set<std::vector<std::string>> different;
    for (std::size_t m = 0; m < members.size(); ++m) {
      std::vector<std::string> own;
      for (const std::string& key : of_physics) own.push_back(value_of(m, key));
      different.insert(own);
    }
    if (different.size() == members.size()) keys = of_physics;
    const auto last_word = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
    const auto short_of = [&](const std::string& key) {
      const auto same = [&](const std::string& other) { return last_word(other) == last_word(key); };
      if (std::count_if(keys.begin(), keys.end(), same) > 1) return key;
      const std::string symbol = symbol_of(key);
      return symbol.empty() ? last_word(key) : symbol;
    };
    const auto as_read = [](const std::string& value) {
      return value.ends_with(".0") ? value.substr(0, value.size() - 2) : value;
    };
    std::map<std::string, int> times_used;
    for (std::size_t m = 0; m < members.size(); ++m) {
      std::string& name = names[members[m]];
      for (std::size_t i = 0; i < keys.size() && keys.size() <= most_keys; ++i) {
        name += fmt::format("{}{} = {}", i > 0 ? ", " : "", short_of(keys[i]), as_read(value_of(m, keys[i])));
      }
      ++times_used[name];
    }
    for (const std::size_t k : members) {
      if (times_used[names[k]] > 1) names[k] += (names[k].empty() ? "" : ", ") + files[k];
      if (groups.size() > 1) names[k] = title + (title.empty() ? "" : ", ") + names[k];
    }
  }
  return names;
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
