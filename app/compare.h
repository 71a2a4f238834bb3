// Compares pictures, one pair or two folders of them, and judges each by one rule.
//
// Beside an expected picture NAME.png there may be company: NAME.alt1.png, NAME.alt2.png, ... are accepted as well, and
// pixels that are white in NAME.mask.png do not count. A file of such a name that is made, too, is a picture of its own.
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
  std::function<void()> look;              ///< called now and then, from any thread; throws CompareStopped to end all
};
struct CompareStopped {};

struct Comparison {
  std::string name;                        ///< path within the folder
  std::filesystem::path expected, actual;  ///< empty where there is none; expected: the baseline that fits best
  std::filesystem::path baseline;          ///< NAME.png itself, whichever fits best
  std::filesystem::path mask;              ///< its own; empty: none
  std::string detail;                      ///< what the rule objects to, or why there was no comparison
  Verdict verdict = Verdict::same;
  render::ImageDifference difference;      ///< of a pair that could be compared
};

struct Comparisons {
  std::vector<Comparison> all;  ///< by name
  std::string passed_over;      ///< a sentence about pictures of other formats; empty: there are none
};

/// All pairs. Throws std::runtime_error with one sentence when the two are not a pair of files or of folders, or hold no picture
/// at all. `progress` hears the share done, from any thread but one at a time. Pictures are held in memory as far as 1 GiB
/// goes, or one pair of them where that takes more.
Comparisons compare_pictures(const CompareRequest&, const std::function<void(double)>& progress);

/// What of a picture is left out: rectangles, the mask for all, and the picture's own.
render::Ignored ignored_pixels(const CompareRequest&, const std::filesystem::path& own_mask, int width, int height);

/// 2 before 1 before 0.
int exit_status(const std::vector<Comparison>&);

/// One line of what was done, or a sentence of what was not.
struct Accepted {
  std::vector<std::string> done, refused;
};
/// Puts the actual picture in the place of NAME.png where the rule is broken or nothing was expected. The old file stays
/// whole until the new one is. What is no picture any more, or would be written beyond the folder, through a link, is refused.
Accepted accept_pictures(const CompareRequest&, std::vector<Comparison>&);

/// Is this a place within the folder, reached without a link in it? Neither needs to exist.
bool stays_within(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace app
