// Compares pictures, one pair or two folders of them, and judges each by one rule.
//
// In a folder of expected pictures NAME.png may have company: NAME.alt1.png, NAME.alt2.png, ... are accepted as well, and
// pixels that are white in NAME.mask.png do not count.
#pragma once

#include "render/compare.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// How a pair came out.
enum class Verdict {
  same,
  different,
  size,        ///< of other width or height
  unreadable,  ///< one of the files, or the mask
  missing,     ///< expected, but not made
  fresh        ///< made, but nothing is expected
};
struct VerdictWords {
  Verdict verdict;
  std::string_view name, meaning;
  int status;  ///< exit status that it causes
};
inline constexpr VerdictWords verdict_words[] = {
    {Verdict::same, "same", "the rule is kept", 0},
    {Verdict::different, "different", "the rule is broken", 1},
    {Verdict::size, "size", "width or height differ", 2},
    {Verdict::unreadable, "unreadable", "a file is damaged or cannot be opened, or the mask leaves nothing to compare", 2},
    {Verdict::missing, "missing", "on the expected side only", 2},
    {Verdict::fresh, "new", "on the actual side only", 2},
};
const VerdictWords& words_of(Verdict);

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;  ///< pixels from the top left corner
};

struct CompareRequest {
  std::filesystem::path expected, actual;  ///< two files or two folders
  render::CompareRule rule;
  std::filesystem::path mask;              ///< for every picture; empty: none
  std::vector<Rectangle> ignored;          ///< in every picture
};

struct Comparison {
  std::string name;                        ///< path within the folder
  std::filesystem::path expected, actual;  ///< empty where there is none; expected: the baseline that fits best
  std::filesystem::path baseline;          ///< NAME.png itself, whichever fits best
  std::string detail;                      ///< what the rule objects to, or why there was no comparison
  Verdict verdict = Verdict::same;
  render::ImageDifference difference;      ///< of a pair that could be compared
};

/// All pairs, by name. Throws std::runtime_error with one sentence when the two are not a pair of files or of folders, or
/// hold no picture at all. `progress` hears the share done, from any thread but one at a time.
std::vector<Comparison> compare_pictures(const CompareRequest&, const std::function<void(double)>& progress);

/// What of a picture is left out: rectangles, the mask for all, and the picture's own.
render::Ignored ignored_pixels(const CompareRequest&, const std::filesystem::path& baseline, int width, int height);

/// 2 before 1 before 0.
int exit_status(const std::vector<Comparison>&);

/// Puts the actual picture in the place of NAME.png where the rule is broken or nothing was expected. The old file stays
/// whole until the new one is. Returns one line for each: what took whose place.
std::vector<std::string> accept_pictures(const CompareRequest&, std::vector<Comparison>&);

}  // namespace app
