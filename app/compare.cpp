#include "compare.h"

#include "output.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

namespace app {

namespace fs = std::filesystem;

namespace {

bool is_picture(const fs::path& path) { return path.extension() == ".png"; }

/// Beside NAME.png: its mask, and further baselines.
fs::path mask_of(const fs::path& baseline) { return fs::path(baseline).replace_extension(".mask.png"); }

/// NAME of NAME.alt1.png, with its folder; empty for other names.
std::string alternative_of(const fs::path& path) {
  const std::string inner = path.stem().extension().string();
  return inner.starts_with(".alt") && inner.size() > 4 ? (path.parent_path() / path.stem().stem()).string() : std::string();
}
bool is_mask(const fs::path& path) { return path.stem().extension() == ".mask"; }

/// Relative path of every picture below a folder.
std::set<std::string> pictures_in(const fs::path& folder) {
  std::set<std::string> names;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder, fs::directory_options::follow_directory_symlink))
      if (is_picture(entry.path()) && !entry.is_directory()) names.insert(entry.path().lexically_relative(folder).string());
  } catch (const fs::filesystem_error& error) {
    throw std::runtime_error(fmt::format("cannot read folder '{}': {}", folder.string(), error.code().message()));
  }
  return names;
}

/// One comparison to be made: the picture and all that it may equal.
struct Pair {
  std::string name;
  fs::path actual;
  std::vector<fs::path> baselines;  ///< NAME.png first, where it exists
  fs::path baseline;                ///< NAME.png
};

std::vector<fs::path> alternatives_beside(const fs::path& baseline) {
  std::vector<fs::path> found;
  std::error_code error;
  const fs::path folder = baseline.has_parent_path() ? baseline.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_picture(entry.path()) && alternative_of(entry.path()) == (folder / baseline.stem()).string())
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Pair> pairs_of(const CompareRequest& request) {
  for (const fs::path& path : {request.expected, request.actual})
    if (!fs::exists(path)) throw std::runtime_error(fmt::format("there is no file or folder '{}'", path.string()));
  const bool folders = fs::is_directory(request.expected);
  if (folders != fs::is_directory(request.actual))
    throw std::runtime_error(fmt::format("'{}' and '{}' must be two files or two folders", request.expected.string(),
                                         request.actual.string()));
  std::vector<Pair> pairs;
  if (!folders) {
    Pair pair{request.actual.filename().string(), request.actual, {request.expected}, request.expected};
    for (const fs::path& path : alternatives_beside(request.expected)) pair.baselines.push_back(path);
    pairs.push_back(std::move(pair));
    return pairs;
  }
  std::map<std::string, Pair> by_name;
  const auto pair_named = [&](const std::string& name) -> Pair& {
    Pair& pair = by_name[name];
    pair.name = name;
    pair.baseline = request.expected / name;
    return pair;
  };
  for (const std::string& name : pictures_in(request.expected)) {
    if (is_mask(name)) continue;
    const std::string of = alternative_of(name);
    Pair& pair = pair_named(of.empty() ? name : of + ".png");
    const fs::path path = request.expected / name;
    if (of.empty()) pair.baselines.insert(pair.baselines.begin(), path);
    else pair.baselines.push_back(path);
  }
  for (const std::string& name : pictures_in(request.actual)) pair_named(name).actual = request.actual / name;
  for (auto& [name, pair] : by_name) pairs.push_back(std::move(pair));
  if (pairs.empty())
    throw std::runtime_error(fmt::format("neither '{}' nor '{}' holds a PNG picture", request.expected.string(),
                                         request.actual.string()));
  return pairs;
}

/// Best first: keeps the rule, could be compared at all, differs least.
bool better(const Comparison& a, const Comparison& b) {
  const auto rank = [](const Comparison& c) { return static_cast<int>(c.verdict); };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a.difference.rmse < b.difference.rmse;
}

Comparison compare_with(const CompareRequest& request, const Pair& pair, const render::Image& actual, const fs::path& path) {
  Comparison result{pair.name, path, pair.actual, pair.baseline, {}, Verdict::same, {}};
  try {
    const render::Image expected = render::read_png(path).image;
    if (expected.width != actual.width || expected.height != actual.height) {
      result.verdict = Verdict::size;
      result.detail = fmt::format("{} x {} expected, {} x {} made", expected.width, expected.height, actual.width,
                                  actual.height);
      return result;
    }
    result.difference = render::difference(expected, actual, request.rule,
                                           ignored_pixels(request, pair.baseline, actual.width, actual.height));
    if (result.difference.compared == 0) throw std::runtime_error("the mask leaves nothing to compare");
    const std::vector<std::string> objections = render::objections(result.difference, request.rule);
    if (!objections.empty()) result.verdict = Verdict::different;
    result.detail = fmt::format("{}", fmt::join(objections, ", "));
  } catch (const std::exception& error) {
    result.verdict = Verdict::unreadable;
    result.detail = error.what();
  }
  return result;
}

Comparison compare_pair(const CompareRequest& request, const Pair& pair) {
  Comparison result{pair.name, {}, pair.actual, pair.baseline, {}, Verdict::missing, {}};
  if (pair.actual.empty()) {
    result.expected = pair.baselines.front();
    result.detail = "expected, but not made";
    return result;
  }
  if (pair.baselines.empty()) {
    result.verdict = Verdict::fresh;
    result.detail = "made, but nothing is expected";
    return result;
  }
  try {
    const render::Image actual = render::read_png(pair.actual).image;
    for (std::size_t k = 0; k < pair.baselines.size(); ++k) {
      Comparison one = compare_with(request, pair, actual, pair.baselines[k]);
      if (k == 0 || better(one, result)) result = std::move(one);
    }
  } catch (const std::exception& error) {
    result.expected = pair.baselines.front();
    result.verdict = Verdict::unreadable;
    result.detail = error.what();
  }
  return result;
}

void ignore_white(const fs::path& path, int width, int height, render::Ignored& ignored) {
  const render::Image mask = render::read_png(path).image;
  if (mask.width != width || mask.height != height)
    throw std::runtime_error(fmt::format("mask '{}' is {} x {}, the picture {} x {}", path.string(), mask.width,
                                         mask.height, width, height));
  for (std::size_t i = 0; i < ignored.size(); ++i)
    if (mask.pixels[i * static_cast<std::size_t>(mask.channels)] >= 128) ignored[i] = 1;
}

}  // namespace

const VerdictWords& words_of(Verdict verdict) {
  return *std::find_if(std::begin(verdict_words), std::end(verdict_words),
                       [verdict](const VerdictWords& w) { return w.verdict == verdict; });
}

render::Ignored ignored_pixels(const CompareRequest& request, const fs::path& baseline, int width, int height) {
  const bool own_mask = fs::exists(mask_of(baseline));
  if (request.ignored.empty() && request.mask.empty() && !own_mask) return {};
  render::Ignored ignored(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const Rectangle& r : request.ignored)
    for (int y = std::max(r.y, 0); y < std::min<long>(height, long{r.y} + r.height); ++y)
      for (int x = std::max(r.x, 0); x < std::min<long>(width, long{r.x} + r.width); ++x)
        ignored[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = 1;
  if (!request.mask.empty()) ignore_white(request.mask, width, height, ignored);
  if (own_mask) ignore_white(mask_of(baseline), width, height, ignored);
  return ignored;
}

std::vector<Comparison> compare_pictures(const CompareRequest& request, const std::function<void(double)>& progress) {
  const std::vector<Pair> pairs = pairs_of(request);
  std::vector<Comparison> results(pairs.size());
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex telling;
  const auto work = [&] {
    for (std::size_t k = next++; k < pairs.size(); k = next++) {
      results[k] = compare_pair(request, pairs[k]);
      const std::lock_guard guard(telling);
      progress(static_cast<double>(++done) / static_cast<double>(pairs.size()));
    }
  };
  std::vector<std::jthread> helpers;
  const std::size_t threads = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), pairs.size());
  for (std::size_t k = 1; k < threads; ++k) helpers.emplace_back(work);
  work();
  helpers.clear();
  return results;
}

int exit_status(const std::vector<Comparison>& all) {
  int status = 0;
  for (const Comparison& c : all) status = std::max(status, words_of(c.verdict).status);
  return status;
}

std::vector<std::string> accept_pictures(const CompareRequest& request, std::vector<Comparison>& all) {
  std::vector<std::string> lines;
  for (Comparison& c : all) {
    const bool takes = c.verdict == Verdict::different || c.verdict == Verdict::size || c.verdict == Verdict::fresh;
    if (!takes) continue;
    const fs::path target = fs::is_directory(request.expected) ? request.expected / c.name : request.expected;
    const bool there = fs::exists(target);
    std::error_code error;
    if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
    write_whole_file(target, read_whole_file(c.actual));
    lines.push_back(there ? fmt::format("{} replaced: {}", target.string(), c.detail) : fmt::format("{} added", target.string()));
    c.verdict = Verdict::same;
  }
  return lines;
}

}  // namespace app
