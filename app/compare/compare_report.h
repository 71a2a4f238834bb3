// Reports of a comparison: lines, JSON, JUnit XML, difference pictures, and an HTML page.
#pragma once

#include "app/compare/compare.h"

namespace app {

/// "different  a/b.png  12 pixels differ by more than 2 (allowed: 10); largest 40, x 3 to 9, y 4 to 17". Names
/// are made printable().
std::string report_line(const Comparison&);
/// "5 pictures: 3 same, 1 different, 1 missing".
std::string report_totals(const std::vector<Comparison>&);

/// One JSON document; infinite limits are null.
std::string report_json(const CompareRequest&, const std::vector<Comparison>&);
/// One test case per picture: different ones are failures, those that could not be compared are errors.
std::string report_junit(const std::vector<Comparison>&);

// Reports replace only earlier reports: files that compare did not write, or has compared, are refused with a
// sentence.

/// Throws std::runtime_error where difference pictures in that folder could be mistaken for compared ones.
void check_difference_folder(const CompareRequest&, const std::filesystem::path& folder);
/// Writes |expected - actual| x 16 of every different pair as FOLDER/NAME.png.
void write_differences(const CompareRequest&, const std::vector<Comparison>&, const std::filesystem::path& folder);
void write_junit(const CompareRequest&, const std::vector<Comparison>&, const std::filesystem::path& file);
/// Writes FOLDER/index.html, with embedded pictures: expected, actual, difference x 16, side by side, blinking or
/// under a slider, worst first. Equal pictures are only named, and so are those beyond 64 MiB of pictures.
void write_page(const CompareRequest&, const std::vector<Comparison>&, const std::filesystem::path& folder);

}  // namespace app
