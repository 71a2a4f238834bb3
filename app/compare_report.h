// What a comparison of pictures tells: lines, JSON, JUnit XML, difference pictures, and a page to look at.
#pragma once

#include "compare.h"

namespace app {

/// "different  a/b.png  12 pixels differ by more than 2 (allowed: 10); largest 40, x 3 to 9, y 4 to 17". Names
/// are made printable().
std::string report_line(const Comparison&);
/// "5 pictures: 3 same, 1 different, 1 missing".
std::string report_totals(const std::vector<Comparison>&);

/// One JSON document; a limit that is infinite is null.
std::string report_json(const CompareRequest&, const std::vector<Comparison>&);
/// One test case a picture: different ones are failures, those that could not be compared are errors.
std::string report_junit(const std::vector<Comparison>&);

// Files take the place of earlier ones of their kind only: what compare did not make, or has compared, is refused with a sentence.

/// Throws std::runtime_error where difference pictures in that folder would be taken for compared ones.
void check_difference_folder(const CompareRequest&, const std::filesystem::path& folder);
/// Writes |expected - actual| x 16 of every different pair as FOLDER/NAME.png.
void write_differences(const CompareRequest&, const std::vector<Comparison>&, const std::filesystem::path& folder);
void write_junit(const CompareRequest&, const std::vector<Comparison>&, const std::filesystem::path& file);
/// Writes FOLDER/index.html, which holds its pictures: expected, actual, difference x 16, side by side, blinking or under a
/// slider, worst first. Equal pictures are named only. Beyond 64 MiB of pictures the rest is named only, too.
void write_page(const CompareRequest&, const std::vector<Comparison>&, const std::filesystem::path& folder);

}  // namespace app
