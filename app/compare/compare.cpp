#include "app/compare/compare.h"

#include "app/scene/output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <initializer_list>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t most_entries = 1'000'000;                       // of a folder, links followed
constexpr std::uint64_t memory_for_pictures = std::uint64_t{1} << 30;  // bytes, of all pairs under way

std::string lower_case(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}
bool has_extension(const fs::path& path, std::initializer_list<std::string_view> extensions) {
  return std::find(extensions.begin(), extensions.end(), lower_case(path.extension().string())) != extensions.end();
}
bool is_picture(const fs::path& path) { return has_extension(path, {".png"}); }
bool is_other_picture(const fs::path& path) {
  return has_extension(path, {".apng", ".avif", ".bmp", ".gif", ".jpeg", ".jpg", ".tif", ".tiff", ".webp"});
}

/// NAME.png of NAME.alt1.png or NAME.mask.png, with its folder; empty for other names.
enum class Company { none, alternative, mask };
std::pair<Company, fs::path> company_of(const fs::path& path) {
  const std::string inner = path.stem().extension().string();
  const fs::path base = path.parent_path() / (path.stem().stem().string() + path.extension().string());
  if (inner == ".mask") return {Company::mask, base};
  const bool numbered =
      inner.starts_with(".alt") && inner.size() > 4 && inner.find_first_not_of("0123456789", 4) == std::string::npos;
  return numbered ? std::pair(Company::alternative, base) : std::pair(Company::none, fs::path());
}

/// What a folder holds: paths within it, all that links to folders lead to included.
struct Found {
  std::set<fs::path> pictures, others;
  std::int64_t entries = 0;
};

using FileId = std::pair<dev_t, ino_t>;

/// `above`: the folders on the way here; one that is met again is a loop of links, and holds nothing new.
void walk(const fs::path& folder, const fs::path& within, std::vector<FileId>& above, const CompareRequest& request,
          Found& found) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) == 0) {
    const FileId id{status.st_dev, status.st_ino};
    if (std::find(above.begin(), above.end(), id) != above.end()) return;
    above.push_back(id);
  } else {
    above.emplace_back();
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (request.look) request.look();
    if (++found.entries > most_entries)
      throw std::runtime_error(
          fmt::format("folder '{}' holds more than {} entries, those that its links lead to included", folder.string(),
                      most_entries));
    std::error_code error;
    const fs::path name = within / entry.path().filename();
    if (fs::is_directory(entry.status(error)))
      walk(entry.path(), name, above, request, found);
    else if (is_picture(name))
      found.pictures.insert(name);
    else if (is_other_picture(name))
      found.others.insert(name);
  }
  above.pop_back();
}

Found pictures_in(const fs::path& folder, const CompareRequest& request) {
  Found found;
  std::vector<FileId> above;
  try {
    walk(folder, {}, above, request, found);
  } catch (const fs::filesystem_error& error) {
    throw std::runtime_error(fmt::format("cannot read folder '{}': {}",
                                         (error.path1().empty() ? folder : error.path1()).string(),
                                         error.code().message()));
  }
  return found;
}

/// One comparison to be made: the picture and all that it may equal.
struct Pair {
  std::string name;
  fs::path actual;
  std::vector<fs::path> baselines;  ///< NAME.png first, where it exists
  fs::path baseline;                ///< NAME.png
  fs::path mask;                    ///< its own; empty: none
};

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

Pair pair_of_files(const CompareRequest& request) {
  Pair pair{request.actual.filename().string(), request.actual, {request.expected}, request.expected, {}};
  const fs::path folder = folder_of(request.expected), other = folder_of(request.actual);
  std::error_code error;
  const bool one_folder = fs::equivalent(folder, other, error);
  std::set<fs::path> alternatives;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path name = entry.path().filename();
    const auto [company, of] = company_of(name);
    if (!is_picture(name) || of != request.expected.filename() || (!one_folder && fs::exists(other / name))) continue;
    if (company == Company::mask) pair.mask = entry.path();
    if (company == Company::alternative) alternatives.insert(entry.path());
  }
  pair.baselines.insert(pair.baselines.end(), alternatives.begin(), alternatives.end());
  return pair;
}

std::vector<Pair> pairs_of_folders(const CompareRequest& request, const Found& expected, const Found& actual) {
  std::map<fs::path, Pair> by_name;
  const auto pair_named = [&](const fs::path& name) -> Pair& {
    Pair& pair = by_name[name];
    pair.name = name.string();
    pair.baseline = request.expected / name;
    return pair;
  };
  for (const fs::path& name : expected.pictures) {
    const auto [company, of] = company_of(name);
    const bool own = company == Company::none || actual.pictures.contains(name) ||
                     !(expected.pictures.contains(of) || actual.pictures.contains(of));
    Pair& pair = pair_named(own ? name : of);
    const fs::path path = request.expected / name;
    if (own)
      pair.baselines.insert(pair.baselines.begin(), path);
    else if (company == Company::mask)
      pair.mask = path;
    else
      pair.baselines.push_back(path);
  }
  for (const fs::path& name : actual.pictures) pair_named(name).actual = request.actual / name;
  std::vector<Pair> pairs;
  for (auto& [name, pair] : by_name) pairs.push_back(std::move(pair));
  return pairs;
}

struct Pairs {
  std::vector<Pair> all;
  std::string passed_over;
};

Pairs pairs_of(const CompareRequest& request) {
  for (const fs::path& path : {request.expected, request.actual})
    if (!fs::exists(path)) throw std::runtime_error(fmt::format("there is no file or folder '{}'", path.string()));
  const bool folders = fs::is_directory(request.expected);
  if (folders != fs::is_directory(request.actual))
    throw std::runtime_error(fmt::format("'{}' and '{}' must be two files or two folders", request.expected.string(),
                                         request.actual.string()));
  if (!folders) return {{pair_of_files(request)}, {}};
  const Found expected = pictures_in(request.expected, request), actual = pictures_in(request.actual, request);
  Pairs pairs{pairs_of_folders(request, expected, actual), {}};
  if (pairs.all.empty())
    throw std::runtime_error(
        fmt::format("neither '{}' nor '{}' holds a PNG picture", request.expected.string(), request.actual.string()));
  if (const std::size_t n = expected.others.size() + actual.others.size(); n > 0)
    pairs.passed_over =
        fmt::format("only PNG pictures are compared: {} of another format {} passed over, such as '{}'", n,
                    n == 1 ? "was" : "were", (actual.others.empty() ? expected : actual).others.begin()->string());
  return pairs;
}

/// Best first: keeps the rule, could be compared at all, differs least.
bool better(const Comparison& a, const Comparison& b) {
  const auto rank = [](const Comparison& c) { return static_cast<int>(c.verdict); };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a.difference.rmse < b.difference.rmse;
}

/// What went wrong, in our words.
std::string reason(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) ? "there is not enough memory to compare it" : error.what();
}

Comparison compare_with(const CompareRequest& request, const Pair& pair, const render::PngFile& actual,
                        const fs::path& path) {
  Comparison result{pair.name, path, pair.actual, pair.baseline, pair.mask, {}, Verdict::same, {}};
  try {
    const render::PngFile expected = render::read_png(path, request.look);
    const int width = actual.image.width, height = actual.image.height;
    if (expected.image.width != width || expected.image.height != height) {
      result.verdict = Verdict::size;
      result.detail =
          fmt::format("{} x {} expected, {} x {} made", expected.image.width, expected.image.height, width, height);
      return result;
    }
    result.difference = render::difference(expected, actual, request.rule,
                                           ignored_pixels(request, pair.mask, width, height), request.look);
    if (result.difference.compared == 0) throw std::runtime_error("the mask leaves nothing to compare");
    const std::vector<std::string> objections = render::objections(result.difference, request.rule);
    if (!objections.empty()) result.verdict = Verdict::different;
    result.detail = fmt::format("{}", fmt::join(objections, ", "));
  } catch (const std::exception& error) {
    result.verdict = Verdict::unreadable;
    result.detail = reason(error);
  }
  return result;
}

Comparison compare_pair(const CompareRequest& request, const Pair& pair) {
  Comparison result{pair.name, {}, pair.actual, pair.baseline, pair.mask, {}, Verdict::missing, {}};
  if (pair.actual.empty()) {
    result.expected = pair.baselines.front();
    result.detail = "expected, but not made";
    return result;
  }
  try {
    const render::PngFile actual = render::read_png(pair.actual, request.look);
    if (pair.baselines.empty()) {
      result.verdict = Verdict::fresh;
      result.detail = "made, but nothing is expected";
    }
    for (std::size_t k = 0; k < pair.baselines.size(); ++k) {
      Comparison one = compare_with(request, pair, actual, pair.baselines[k]);
      if (k == 0 || better(one, result)) result = std::move(one);
    }
  } catch (const std::exception& error) {
    if (!pair.baselines.empty()) result.expected = pair.baselines.front();
    result.verdict = Verdict::unreadable;
    result.detail = reason(error);
  }
  return result;
}

/// Bytes that a pair's pictures take.
std::uint64_t memory_of(const Pair& pair) {
  std::uint64_t most = 0;
  for (const fs::path& path : pair.baselines) most = std::max(most, render::png_memory(path));
  return most + render::png_memory(pair.actual);
}

/// Lets as many pairs be compared at a time as there is memory for; any pair when it is alone.
class MemoryGate {
 public:
  void enter(std::uint64_t bytes) {
    std::unique_lock guard(mutex_);
    left_.wait(guard, [&] { return taken_ == 0 || taken_ + bytes <= memory_for_pictures; });
    taken_ += bytes;
  }
  void leave(std::uint64_t bytes) {
    const std::lock_guard guard(mutex_);
    taken_ -= bytes;
    left_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable left_;
  std::uint64_t taken_ = 0;
};

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

render::Ignored ignored_pixels(const CompareRequest& request, const fs::path& own_mask, int width, int height) {
  if (request.ignored.empty() && request.mask.empty() && own_mask.empty()) return {};
  render::Ignored ignored(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const Rectangle& r : request.ignored)
    for (int y = std::max(r.y, 0); y < std::min<long>(height, long{r.y} + r.height); ++y)
      for (int x = std::max(r.x, 0); x < std::min<long>(width, long{r.x} + r.width); ++x)
        ignored[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = 1;
  if (!request.mask.empty()) ignore_white(request.mask, width, height, ignored);
  if (!own_mask.empty()) ignore_white(own_mask, width, height, ignored);
  return ignored;
}

Comparisons compare_pictures(const CompareRequest& request, const std::function<void(double)>& progress) {
  const Pairs pairs = pairs_of(request);
  Comparisons results{std::vector<Comparison>(pairs.all.size()), pairs.passed_over};
  std::atomic<std::size_t> next = 0, done = 0;
  std::atomic<bool> stopped = false;
  std::mutex telling;
  MemoryGate gate;
  const auto work = [&] {
    for (std::size_t k = next++; k < pairs.all.size() && !stopped; k = next++) {
      const std::uint64_t memory = memory_of(pairs.all[k]);
      gate.enter(memory);
      try {
        if (request.look) request.look();
        results.all[k] = compare_pair(request, pairs.all[k]);
      } catch (const CompareStopped&) {
        stopped = true;
      }
      gate.leave(memory);
      const std::lock_guard guard(telling);
      progress(static_cast<double>(++done) / static_cast<double>(pairs.all.size()));
    }
  };
  std::vector<std::jthread> helpers;
  const std::size_t threads =
      std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), pairs.all.size());
  for (std::size_t k = 1; k < threads; ++k) helpers.emplace_back(work);
  work();
  helpers.clear();
  if (stopped) throw CompareStopped{};
  return results;
}

int exit_status(const std::vector<Comparison>& all) {
  int status = 0;
  for (const Comparison& c : all) status = std::max(status, words_of(c.verdict).status);
  return status;
}

bool stays_within(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(file, error))) return false;
  error.clear();  // it need not be there
  const auto resolved = [&](const fs::path& path) {
    return error ? path : fs::weakly_canonical(fs::absolute(path), error);
  };
  const fs::path root = resolved(folder), place = resolved(folder_of(file));
  return !error && std::mismatch(root.begin(), root.end(), place.begin(), place.end()).first == root.end();
}

namespace {

/// Takes one picture; the line that says so.
std::string accept_picture(const CompareRequest& request, const Comparison& c) {
  const bool folders = fs::is_directory(request.expected);
  const fs::path target = folders ? request.expected / c.name : request.expected;
  if (folders && !stays_within(request.expected, target))
    throw std::runtime_error(fmt::format("a link leads from '{}' to somewhere else", target.string()));
  const std::string bytes = read_whole_file(c.actual);
  render::png_from(bytes, c.actual);  // whatever was compared: from here on this is what is expected
  const bool there = fs::exists(target);
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  write_whole_file(target, bytes);
  return there ? fmt::format("{} replaced: {}", target.string(), c.detail) : fmt::format("{} added", target.string());
}

}  // namespace

Accepted accept_pictures(const CompareRequest& request, std::vector<Comparison>& all) {
  Accepted accepted;
  for (Comparison& c : all) {
    const bool takes = c.verdict == Verdict::different || c.verdict == Verdict::size || c.verdict == Verdict::fresh;
    if (!takes) continue;
    try {
      if (request.look) request.look();
      accepted.done.push_back(accept_picture(request, c));
      c.verdict = Verdict::same;
    } catch (const CompareStopped&) {
      accepted.refused.emplace_back("interrupted; the remaining pictures are not accepted");
      break;
    } catch (const std::exception& error) {
      accepted.refused.push_back(fmt::format("{} is not accepted: {}", c.name, error.what()));
    }
  }
  return accepted;
}

}  // namespace app
