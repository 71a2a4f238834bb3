// The command validate: sections of a page of measured values and their references.
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/base/progress.h"
#include "app/base/result_files.h"
#include "app/commands/commands.h"
#include "app/scene/output.h"
#include "app/validate/validations.h"

#include "sim/core/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <system_error>

namespace app {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void print_validations() {
  for (const ValidationRow& row : validations()) fmt::print("{:<20} {}\n", row.name, row.meaning);
  fmt::print("{:<20} {}\n", "all", "all of these");
}

/// Those asked for, each once, in the order of the page.
std::vector<ValidationRow> asked_rows(const std::vector<std::string>& words) {
  const std::vector<std::string_view> names = validation_names();
  for (const std::string& word : words)
    if (std::find(names.begin(), names.end(), word) == names.end())
      throw std::runtime_error(fmt::format("'{}' is not a validation{}", word, sim::suggestion(word, names)));
  std::vector<ValidationRow> rows;
  for (const ValidationRow& row : validations())
    if (std::any_of(words.begin(), words.end(), [&](const std::string& w) { return w == "all" || w == row.name; }))
      rows.push_back(row);
  return rows;
}

/// -o names the page where it ends in .md, else its folder.
fs::path page_path(const fs::path& output) {
  const fs::path given = output.empty() ? fs::path("validate") : output;
  return given.extension() == ".md" && !fs::is_directory(given) ? given : given / "validation.md";
}

std::string picture_name(const ValidationRow& row) { return fmt::format("pictures/validation-{}.svg", row.name); }

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return fmt::format("{:04}-{:02}-{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday);
}

struct Measured {
  Section section;
  Measurement how;
};

Measured measure(const ValidationRow& row, int threads, const std::function<void(const std::string&, double)>& show) {
  const auto start = Clock::now();
  Trials trials(threads, [&](const std::string& detail) { show(detail, seconds_since(start)); });
  Section section;
  try {
    section = row.measure(trials);
  } catch (const std::system_error&) {
    throw;  // a full disk says nothing about physics
  } catch (const std::runtime_error& error) {
    section.text = fmt::format("Failed: {}.", error.what());
    section.failures = 1;
  }
  return {std::move(section),
          {std::string(row.name), today(), seconds_since(start), trials.count(), trials.first_command()}};
}

/// The section in its place; what the page has besides stays.
void renew_page(const fs::path& page, const std::string& section, const sim::FileWriter& write) {
  std::vector<std::string> order;
  for (const ValidationRow& row : validations()) order.push_back(section_title(row.name));
  write(page, with_section(fs::exists(page) ? read_whole_file(page) : std::string(), section, order));
}

}  // namespace

std::vector<std::string_view> validation_names() {
  std::vector<std::string_view> names{"all"};
  for (const ValidationRow& row : validations()) names.push_back(row.name);
  return names;
}

int validate(const Options& options) {
  if (options.words.empty()) {
    print_validations();
    return 0;
  }
  const std::vector<ValidationRow> asked = asked_rows(options.words);
  const fs::path page = page_path(options.output), folder = page.parent_path();
  ResultFiles results({}, options.force);
  const sim::FileWriter write = results.writer_inside();
  results.require_inside(page);  // before hours of work
  for (const ValidationRow& row : asked) results.require_inside(folder / picture_name(row));
  const fs::path pictures = folder / "pictures";
  std::error_code error;
  fs::create_directories(pictures, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", pictures.string(), error.message()));

  double done = 0, all = 0;
  for (const ValidationRow& row : asked) all += row.seconds;
  int failures = 0;
  for (const ValidationRow& row : asked) {
    Progress progress(std::string(row.name), options.quiet);
    try {
      Measured measured = measure(row, std::max(options.jobs, 1), [&](const std::string& detail, double seconds) {
        progress.show((done + std::min(seconds, 0.99 * row.seconds)) / all, detail);
      });
      progress.clear();
      done += row.seconds;
      Section& section = measured.section;
      if (section.figure) {
        section.figure->drawing.title = fmt::format("Validation: {}", row.name);
        render::write_drawing_svg(folder / picture_name(row), section.figure->drawing, write);
      }
      renew_page(page, markdown_text(section, measured.how, picture_name(row)), write);
      results.settle();
      failures += section.failures;
      if (!options.quiet) fmt::print("{}\n", plain_text(section, measured.how));
      if (!options.quiet) std::fflush(stdout);
      if (section.failures > 0)
        tell(section.tables.empty()
                 ? fmt::format("{}: {}", row.name, section.text)
                 : fmt::format("{}: {} of its rows miss their reference", row.name, section.failures));
    } catch (const Interrupted&) {
      progress.clear();
      results.settle();
      tell(fmt::format("interrupted in {}; its section of '{}' is as it was", row.name, page.string()));
      return interrupted_status;
    }
  }
  if (!options.quiet) fmt::print("{}\n", printable(page.string()));
  return failures > 0 ? 1 : 0;
}

}  // namespace app
