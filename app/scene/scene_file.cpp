#include "app/scene/scene_file.h"

#include "app/base/interrupt.h"
#include "app/base/printable.h"
#include "app/scene/catalogues.h"
#include "app/scene/scene_overrides.h"
#include "app/scene/scene_start.h"
#include "app/scene/scene_values.h"

#include "render/core/ground.h"
#include "render/core/palette.h"
#include "sim/core/derived.h"
#include "sim/core/digits.h"
#include "sim/core/input_file.h"
#include "sim/membrane/cell.h"
#include "sim/surface/shapes.h"
#include "sim/suspension/placements.h"

#include <fmt/format.h>

#include <cmath>

namespace app {

namespace {

const Catalogue* find_catalogue(std::string_view name) {
  for (const Catalogue& c : catalogues())
    if (c.name == name) return &c;
  return nullptr;
}

const Selector* find_selector(std::string_view section) {
  for (const Selector& s : selectors)
    if (s.section == section) return &s;
  return nullptr;
}

bool contains(const std::vector<std::string_view>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// For a key that stands where it does not belong, or is misspelt: " (did you mean 'vesicle.viscosity_contrast'?)", all
/// tables that have it; empty when no table has a key like it.
std::string key_elsewhere(std::string_view word, bool misspelt) {
  std::vector<std::pair<std::string_view, std::string_view>> keys;  // table, key
  const Settings defaults;
  visit_sections(defaults, [&](const sim::Section& section, const auto& parameters) {
    const auto add = [&](const auto& one) {
      visit(one, [&](const sim::Parameter& p, const auto&) { keys.emplace_back(section.name, p.name); });
    };
    if constexpr (requires { parameters.begin(); })
      add(typename std::decay_t<decltype(parameters)>::value_type{});
    else
      add(parameters);
  });
  std::vector<std::string_view> names;
  for (const auto& [table, key] : keys) names.push_back(key);
  const std::string_view meant = contains(names, word) ? word : misspelt ? sim::nearest_word(word, names) : "";
  std::string text;
  for (const auto& [table, key] : keys)
    if (key == meant) text += fmt::format("{}'{}.{}'", text.empty() ? "" : " or ", table, key);
  return text.empty() ? text : fmt::format(" (did you mean {}?)", text);
}

/// Kinds of a table that read a key; empty: the key belongs to all kinds.
std::vector<std::string_view> owners(std::string_view section, std::string_view key) {
  std::vector<std::string_view> names;
  if (const Selector* selector = find_selector(section))
    for (const auto& row : find_catalogue(selector->catalogue)->rows)
      if (contains(row.keys, key)) names.push_back(row.name);
  return names;
}

const toml::source_region& source_of(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node ? node->source() : table.source();
}

std::string text_of(const std::filesystem::path& path) {
  std::string why;
  std::ifstream in = sim::open_input(path, why);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be read: {}", path.string(), why));
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What is no text at all is called by its name.
void refuse_other_files(std::string_view text, const std::filesystem::path& path) {
  struct Kind {
    std::string_view start, what;
  };
  constexpr Kind kinds[] = {
      {"\211HDF\r\n\032\n", "a trajectory or another HDF5 file, not a scene; 'tanktread info' tells what is in it"},
      {"\211PNG\r\n\032\n", "a picture, not a scene"},
      {"\377\330\377", "a picture, not a scene"}};
  if (text.empty()) throw std::runtime_error(fmt::format("{}: is empty", path.string()));
  for (const Kind& kind : kinds)
    if (text.starts_with(kind.start)) throw std::runtime_error(fmt::format("{}: is {}", path.string(), kind.what));
  if (text.find('\0') != std::string_view::npos)
    throw std::runtime_error(fmt::format("{}: is not a text, hence no scene", path.string()));
}

/// Is an optional, text or list member of a kind that needs it not given?
template <class T>
bool missing(const T&) {
  return false;
}
template <class T>
bool missing(const std::optional<T>& value) {
  return !value;
}
template <class T>
bool missing(const std::vector<T>& value) {
  return value.empty();
}
bool missing(const std::string& value) { return value.empty(); }

template <class P>
std::string_view selected(const P&) {
  return {};
}
std::string_view selected(const sim::FlowParameters& p) { return p.kind; }
std::string_view selected(const sim::VesicleParameters& p) { return p.shape; }
std::string_view selected(const sim::PlacementParameters& p) { return p.kind; }

struct Reader {
  const toml::table& root;
  std::string name;
  std::filesystem::path folder;
  SceneUse use;

  // What no single range can say.
  template <class P>
  void check(const toml::table&, P&) const {}
  void check(const toml::table& table, sim::FlowParameters& p) const {
    if (p.until <= p.from) fail_at(source_of(table, "until"), fmt::format("'until' must be after 'from', {}", p.from));
    for (const TimeFactorKey& k : time_factor_keys)
      if (table.contains(k.key) && p.time_factor != k.factor)
        fail_at(source_of(table, k.key),
                fmt::format("'{}' is a key of time_factor '{}', not of '{}'", k.key, k.factor, p.time_factor));
  }
  void check(const toml::table& table, render::ViewParameters& p) const {
    if (p.size.size() != 2) fail_at(source_of(table, "size"), "'size' must be two whole numbers, [width, height]");
    if (p.cut_normal.norm() == 0) fail_at(source_of(table, "cut_normal"), "'cut_normal' must not be the zero vector");
    if (p.copies.size() != 3)
      fail_at(source_of(table, "copies"), "'copies' must be three whole numbers, of copies along x, y and z");
    if (p.up.norm() == 0) fail_at(source_of(table, "up"), "'up' must not be the zero vector");
    try {
      for (const std::string& colour : p.colours) render::parse_colour(colour);
    } catch (const std::invalid_argument& error) {
      fail_at(source_of(table, "colours"), error.what());
    }
    try {
      render::ground_of(p.background);
    } catch (const std::invalid_argument& error) {
      fail_at(source_of(table, "background"), error.what());
    }
  }
  void check(const toml::table& table, render::FigureParameters& p) const {
    if (p.out.find('/') != std::string::npos || p.out == "." || p.out == "..")
      fail_at(source_of(table, "out"),
              fmt::format("'out' must be a file name without folders, not '{}'; results stay in the "
                          "output folder ('tanktread figure -o' writes anywhere)",
                          p.out));
    if (printable(p.out) != p.out)
      fail_at(source_of(table, "out"),
              fmt::format("'out' must be a file name without control characters, not '{}'", p.out));
  }
  void check(const toml::table& table, sim::TimeParameters& p) const {
    if (p.step && p.tolerance)
      fail_at(source_of(table, "step"), "give 'step', fixed steps, or 'tolerance', steps that follow it, not both");
    const bool adapts = sim::steps_adapt(p);
    p.scheme = adapts ? "adaptive" : p.scheme.value_or("bdf2");
    if (adapts && p.step)
      fail_at(source_of(table, "step"),
              "the scheme 'adaptive' chooses its steps; give 'tolerance' or another 'scheme'");
    if (!adapts && p.tolerance)
      fail_at(source_of(table, "tolerance"), fmt::format("the scheme '{}' takes fixed steps; give 'step'", *p.scheme));
    if (!adapts && !p.step)
      fail_at(source_of(table, "scheme"), fmt::format("the scheme '{}' takes fixed steps; give 'step'", *p.scheme));
    if (adapts) p.tolerance = sim::tolerance_of(p);
    p.save_every = sim::save_interval(p);
    for (const auto& [key, length] : {std::pair{"step", p.step}, std::pair{"save_every", p.save_every}})
      if (const double steps = length ? p.end / *length : 0; steps > most_steps)
        fail_at(source_of(table, key), fmt::format("{:.3g} steps are too many; '{}' must be longer", steps, key));
  }
  void check(const toml::table& table, sim::PlacementParameters& p) const {
    if (p.kind != "file") return;
    const std::filesystem::path path = std::filesystem::absolute(folder / p.file).lexically_normal();
    if (!std::filesystem::is_regular_file(path))
      fail_at(source_of(table, "file"), fmt::format("there is no file '{}'", path.string()));
    p.file = path.string();
  }
  void check(const toml::table& table, sim::VesicleParameters& p) const {
    if (p.area && p.radius) fail_at(source_of(table, "radius"), "give 'area' or 'radius', not both");
    if (p.axis && p.axis->norm() == 0) fail_at(source_of(table, "axis"), "'axis' must not be the zero vector");
    for (const auto& term : p.coefficients)
      if (term[0] < 0 || term[0] != std::floor(term[0]) || term[1] != std::floor(term[1]) ||
          std::abs(term[1]) > term[0])
        fail_at(source_of(table, "coefficients"),
                fmt::format("[{}, {}, {}] is no term [n, m, value] with whole n >= 0 and |m| <= n", term[0], term[1],
                            term[2]));
    if (use == SceneUse::draw) return;
    if (starts_from_file()) {  // the shapes are those of its state, whatever has become of tables
      if (p.shape == "file") p.file = std::filesystem::absolute(folder / p.file).lexically_normal().string();
      return;
    }
    if (p.shape == "file") {
      const std::filesystem::path path = std::filesystem::absolute(folder / p.file).lexically_normal();
      if (!std::filesystem::is_regular_file(path))
        fail_at(source_of(table, "file"), fmt::format("there is no file '{}'", path.string()));
      p.file = path.string();
      const std::string own = checksum(text_of(path));
      if (p.checksum && *p.checksum != own)
        fail_at(source_of(table, "checksum"),
                fmt::format("the file '{}' has changed: its checksum is {}", p.file, own));
      p.checksum = own;
    } else if (p.checksum) {
      fail_at(source_of(table, "checksum"), fmt::format("'checksum' is a key of shape 'file', not of '{}'", p.shape));
    }
    try {
      sim::initial_position(p);
    } catch (const std::exception& error) {
      fail_at(source_of(table, p.shape == "file" ? "file" : "shape"), error.what());
    }
  }

  void check(const toml::table& table, sim::StartParameters& p) const {
    if (!p.from) {
      for (const char* key : {"time", "strain", "checksum"})
        if (table.contains(key)) fail_at(source_of(table, key), fmt::format("'{}' is of a start 'from' a file", key));
    } else if (p.from->empty()) {
      fail_at(source_of(table, "from"), "'from' must be the name of a trajectory");
    } else if (use == SceneUse::simulate) {
      p.from = std::filesystem::absolute(folder / *p.from).lexically_normal().string();
    }
  }
  bool starts_from_file() const { return root["start"]["from"].is_string(); }

  /// What a start takes from its file; the state, where that was read.
  std::optional<sim::State> resolve_start(sim::Scene& scene, const std::filesystem::path& continued) const {
    const bool own_vesicles = root.contains("vesicle");
    if (!own_vesicles && root.contains("placement"))
      fail_at(root.get("placement")->source(),
              "the vesicles are those of the file of the start: leave [[placement]] out, or give the [[vesicle]] that "
              "it copies");
    const auto scene_there = [](std::string_view text, const std::filesystem::path& path) {
      return parse_scene(text, path.string() + " (its scene)", ".", {}, SceneUse::draw).scene;
    };
    try {
      return take_start(scene, own_vesicles, continued, scene_there);
    } catch (const WrongKey& wrong) {
      fail_at(source_of(table_with(wrong.table, wrong.key), wrong.key), wrong.what());
    }
  }

  /// The table that is meant: of several, the first one with the key.
  const toml::table& table_with(std::string_view section, std::string_view key) const {
    const toml::node* node = root.get(section);
    if (node && node->is_table()) return *node->as_table();
    if (node && node->is_array())
      for (const toml::node& item : *node->as_array())
        if (const toml::table* table = item.as_table(); table && table->contains(key)) return *table;
    return root;
  }
  void check_cell(const sim::Scene& scene) const {
    if (const auto objection = sim::scene_objection(scene))
      fail_at(source_of(table_with(objection->table, objection->key), objection->key), objection->reason);
    if (!scene.cell.size) return;
    const toml::table& placement = table_with("placement", "volume_fraction");
    if (!placement.contains("volume_fraction")) return;
    for (const sim::PlacementParameters& p : scene.placements)
      if (p.kind == "lattice" || p.kind == "box")
        fail_at(source_of(placement, "volume_fraction"),
                "the size of the [cell] and 'count' set the volume fraction; leave 'volume_fraction' out");
  }

  /// What depends on more than one table.
  void check_together(const sim::Scene& scene) const {
    check_cell(scene);
    const sim::NumericsParameters& n = scene.numerics;
    const toml::table* table = root["numerics"].as_table();
    if (!table) return;
    for (const sim::VesicleParameters& v : scene.vesicles)
      if (n.source_order > 0 && n.source_order < v.order)
        fail_at(source_of(*table, "source_order"),
                fmt::format("'source_order' must be at least the vesicles' order {}, not {}", v.order, n.source_order));
    for (const sim::VesicleParameters& v : scene.vesicles)
      if (n.source_order > 0 && sim::order_follows(scene.time, v) && n.source_order < n.most_order)
        fail_at(source_of(*table, "source_order"),
                fmt::format("'source_order' must be at least most_order = {} where an order is \"auto\", not {}",
                            n.most_order, n.source_order));
    if (n.least_order > n.most_order)
      fail_at(source_of(*table, n.least_order != sim::NumericsParameters{}.least_order ? "least_order" : "most_order"),
              fmt::format("'least_order' {} is above 'most_order' {}", n.least_order, n.most_order));
  }

  /// Once all vesicles are known.
  void check_copies(const Settings& settings) const {
    const std::vector<int>& copies = settings.view.copies;
    if (copies[0] == 0 && copies[1] == 0 && copies[2] == 0) return;
    const toml::source_region& source = source_of(*root["view"].as_table(), "copies");
    if (!settings.scene.cell.size) fail_at(source, "only a periodic [cell] has copies to draw: leave 'copies' out");
    constexpr double most = 20000;
    double all = static_cast<double>(settings.scene.vesicles.size());
    for (const int number : copies) all *= 2 * number + 1;
    if (all > most)
      fail_at(source, fmt::format("{:.0f} vesicles and copies are too many for a picture; give smaller numbers", all));
  }

  /// Every result has a name of its own.
  void check_names(const Settings& settings) const {
    const toml::node* node = root.get("figure");
    const toml::array* tables = node ? node->as_array() : nullptr;
    std::vector<std::string> taken;
    for (std::size_t k = 0; k < settings.figures.size(); ++k) {
      const render::FigureParameters& figure = settings.figures[k];
      const toml::table* table = tables ? tables->get(k)->as_table() : node->as_table();
      const std::string& stem = figure.out.empty() ? figure.kind : figure.out;
      if (std::find(taken.begin(), taken.end(), stem) != taken.end())
        fail_at(source_of(*table, figure.out.empty() ? "kind" : "out"),
                fmt::format("two figures would be called '{}'; give one of them another 'out'", stem));
      if (settings.movie.poster && stem == "poster")
        fail_at(source_of(*table, "out"),
                "the poster of the movie is called 'poster' already; give the figure another 'out'");
      taken.push_back(stem);
    }
  }

  template <class P>
  void read_table(const sim::Section& section, const toml::table& table, P& parameters) const {
    std::vector<std::string_view> known;
    visit(parameters, [&](const sim::Parameter& p, auto&) { known.push_back(p.name); });
    for (const auto& [key, node] : table)
      if (!contains(known, key.str())) {
        const std::string elsewhere = key_elsewhere(key.str(), false);
        fail_at(key.source(), fmt::format("unknown key '{}' in [{}]{}", key.str(), section.name,
                                          elsewhere.empty() ? sim::suggestion(key.str(), known) : elsewhere));
      }
    visit(parameters, [&](const sim::Parameter& p, auto& value) {
      if (const toml::node* node = table.get(p.name))
        read_value(p, *node, value);
      else if (p.required)
        fail_at(table.source(), fmt::format("[{}] needs '{}': {}", section.name, p.name, p.meaning));
    });
    check_kind(section, table, parameters);
    check(table, parameters);
  }

  /// Keys of other kinds are refused; keys of this kind that have no default are required.
  template <class P>
  void check_kind(const sim::Section& section, const toml::table& table, P& parameters) const {
    const Selector* selector = find_selector(section.name);
    if (!selector) return;
    const std::string_view kind = selected(parameters);
    for (const auto& [key, node] : table)
      if (const auto kinds = owners(section.name, key.str()); !kinds.empty() && !contains(kinds, kind))
        fail_at(key.source(), fmt::format("'{}' is {}", key.str(), key_belongs_to(section.name, key.str(), kind)));
    visit(parameters, [&](const sim::Parameter& p, auto& value) {
      if (!p.computed && contains(owners(section.name, p.name), kind) && missing(value))
        fail_at(source_of(table, selector->key),
                fmt::format("{} '{}' needs the key '{}', {}", selector->noun, kind, p.name, p.meaning));
    });
  }

  template <class P>
  void operator()(const sim::Section& section, P& parameters) const {
    const toml::node* node = root.get(section.name);
    if (!node && section.required)
      throw std::runtime_error(fmt::format("{}: the table [{}] is missing", name, section.name));
    if (!node) return;
    if (!node->is_table())
      fail_at(node->source(), fmt::format("'{}' must be one table, [{}]", section.name, section.name));
    read_table(section, *node->as_table(), parameters);
  }

  template <class P>
  void operator()(const sim::Section& section, std::vector<P>& list) const {
    const toml::node* node = root.get(section.name);
    const bool elsewhere = section.name == "vesicle" && starts_from_file();
    if (!node && section.required && !elsewhere)
      throw std::runtime_error(fmt::format("{}: the table [[{}]] is missing", name, section.name));
    if (!node) return;
    if (const toml::table* table = node->as_table()) return read_table(section, *table, list.emplace_back());
    const toml::array* tables = node->as_array();
    if (!tables)
      fail_at(node->source(),
              fmt::format("'{}' must be a table, [{}] or [[{}]]", section.name, section.name, section.name));
    for (const toml::node& item : *tables) {
      if (!item.is_table()) fail_at(item.source(), fmt::format("'{}' must hold tables", section.name));
      read_table(section, *item.as_table(), list.emplace_back());
    }
    if (list.empty() && section.required)
      throw std::runtime_error(fmt::format("{}: [[{}]] is empty", name, section.name));
  }
};

}  // namespace

bool key_applies(std::string_view section, std::string_view key, std::string_view kind, std::string_view time_factor) {
  const auto kinds = owners(section, key);
  if (!kinds.empty() && !contains(kinds, kind)) return false;
  if (section != "flow") return true;
  for (const TimeFactorKey& k : time_factor_keys)
    if (k.key == key && k.factor != time_factor) return false;
  return true;
}

std::string key_belongs_to(std::string_view section, std::string_view key, std::string_view kind) {
  std::string names;
  for (const std::string_view owner : owners(section, key))
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", owner);
  return fmt::format("a key of {} {}, not of '{}'", find_selector(section)->noun, names, kind);
}

Settings parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                     const std::vector<std::string>& overrides, SceneUse use, const std::filesystem::path& continued) {
  toml::table root;
  try {
    root = parse_toml(text, name);
  } catch (const toml::parse_error& error) {
    fail_at(error.source(), error.description());
  }
  for (const std::string& change : overrides) apply_override(root, change);

  Settings settings;
  std::vector<std::string_view> known{"title"};
  visit_sections(settings, [&](const sim::Section& section, auto&) { known.push_back(section.name); });
  for (const auto& [key, node] : root)
    if (!contains(known, key.str())) {
      const bool table = node.is_table() || node.is_array_of_tables();
      const std::string elsewhere = table ? "" : key_elsewhere(key.str(), sim::nearest_word(key.str(), known).empty());
      fail_at(key.source(), fmt::format("unknown {} '{}'{}", table ? "table" : "key", key.str(),
                                        elsewhere.empty() ? sim::suggestion(key.str(), known) : elsewhere));
    }
  if (const toml::node* title = root.get("title"))
    read_value(sim::Parameter{.name = "title", .unit = "", .meaning = "title of the scene"}, *title,
               settings.scene.title);
  const Reader reader{root, name, folder, use};
  visit_sections(settings, reader);
  std::optional<sim::State> start;
  if (use == SceneUse::simulate && settings.scene.start.from) start = reader.resolve_start(settings.scene, continued);
  if (use == SceneUse::simulate) {
    reader.check_together(settings.scene);
    reader.check_names(settings);
  }
  if (const auto poster = settings.movie.poster;
      use == SceneUse::simulate && poster && *poster > settings.scene.time.end * (1 + 1e-9)) {
    const auto [wanted, end] = sim::told_apart(*poster, settings.scene.time.end);
    fail_at(source_of(*root["movie"].as_table(), "poster"),
            fmt::format("'poster' must be at most time.end, {}, not {}", end, wanted));
  }
  if (const double part = settings.movie.time_per_frame, frames = settings.scene.time.end / part;
      part > 0 && frames > most_frames)
    fail_at(source_of(*root["movie"].as_table(), "time_per_frame"),
            fmt::format("{:.3g} frames are too many; 'time_per_frame' must be longer", frames));
  if (use == SceneUse::simulate && !settings.scene.placements.empty()) try {
      settings.scene = sim::placed(std::move(settings.scene), interrupted);
    } catch (const std::invalid_argument& error) {
      fail_at(root.get("placement")->source(), error.what());
    }
  if (start) {
    sim::Plans plans;
    if (const auto objection = sim::start_objection(plans, settings.scene, *start))
      fail_at(source_of(reader.table_with(objection->table, objection->key), objection->key), objection->reason);
  }
  reader.check_copies(settings);
  return settings;
}

Settings read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                    const std::filesystem::path& continued) {
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw std::runtime_error(fmt::format("{}: there is no such scene file", path.string()));
  if (!std::filesystem::is_regular_file(path, error))
    throw std::runtime_error(fmt::format("{}: is not a file", path.string()));
  constexpr std::uintmax_t largest = 64 << 20;  // some hundred thousand vesicles
  if (std::filesystem::file_size(path, error) > largest && !error)
    throw std::runtime_error(fmt::format("{}: is too large for a scene", path.string()));
  const std::string text = text_of(path);
  refuse_other_files(text, path);
  return parse_scene(text, path.string(), path.has_parent_path() ? path.parent_path() : ".", overrides,
                     SceneUse::simulate, continued);
}

}  // namespace app
