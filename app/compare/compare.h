// Compares pictures, one pair or two folders of them, and judges each by one rule.
//
// Beside an expected picture NAME.png, NAME.alt1.png, NAME.alt2.png, ... are accepted as well, and pixels that are
// white in NAME.mask.png are ignored. A file with such a name that is also among the actual pictures is an ordinary
// picture.
#pragma once

#include "render/image/difference.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// Result for one pair.
enum class Verdict {
  same,
  different,
  size,        ///< different width or height
  unreadable,  ///< one of the files, or the mask
  missing,     ///< expected, but not among the actual pictures
  fresh        ///< no expected picture
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
    {Verdict::unreadable, "unreadable", "a file is damaged or cannot be opened, or the mask leaves nothing to compare",
     2},
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
  std::filesystem::path mask;      ///< for every picture; empty: none
  std::vector<Rectangle> ignored;  ///< in every picture
  std::function<void()> look;      ///< called from time to time, from any thread; throws CompareStopped to stop
};
struct CompareStopped {};

struct Comparison {
  std::string name;                        ///< path within the folder
  std::filesystem::path expected, actual;  ///< empty if there is none; expected: the baseline that fits best
  std::filesystem::path baseline;          ///< NAME.png itself, whichever fits best
  std::filesystem::path mask;              ///< its own; empty: none
  std::string detail;                      ///< violations of the rule, or why there was no comparison
  Verdict verdict = Verdict::same;
  render::ImageDifference difference;  ///< of a pair that could be compared
};

struct Comparisons {
  std::vector<Comparison> all;  ///< by name
  std::string passed_over;      ///< a sentence about skipped pictures in other formats; empty: none
};

/// All pairs. Throws std::runtime_error with one sentence when the two are not a pair of files or of folders, or
/// contain no picture. `progress` receives the share done, from any thread but one at a time. Pictures are held in
/// memory up to 1 GiB, or one pair of them where that needs more.
Comparisons compare_pictures(const CompareRequest&, const std::function<void(double)>& progress);

/// Ignored pixels of a picture: rectangles, the common mask, and its own mask.
render::Ignored ignored_pixels(const CompareRequest&, const std::filesystem::path& own_mask, int width, int height);

/// 2 before 1 before 0.
int exit_status(const std::vector<Comparison>&);

/// A line for everything done, a sentence for everything refused.
struct Accepted {
  std::vector<std::string> done, refused;
};
/// Replaces NAME.png by the actual picture where they differ or nothing was expected. The old file stays complete
/// until the new one is. Files that are no longer pictures, or would be written outside the folder through a link,
/// are refused.
Accepted accept_pictures(const CompareRequest&, std::vector<Comparison>&);

/// Whether this path is within the folder, reached without a link in it. Neither needs to exist.
bool stays_within(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace app
