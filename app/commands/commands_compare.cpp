// The command that compares pictures. Its exit status is its answer: 0 same, 1 different, 2 could not compare.
#include "app/base/interrupt.h"
#include "app/base/message.h"
#include "app/base/printable.h"
#include "app/base/progress.h"
#include "app/commands/commands.h"
#include "app/compare/compare_report.h"
#include "app/scene/output.h"

#include "sim/core/catalogue.h"

#include <fmt/format.h>

#include <stdio_ext.h>

#include <charconv>
#include <new>
#include <system_error>

namespace app {

namespace {

/// "X,Y,WxH".
Rectangle rectangle_of(const std::string& text) {
  Rectangle r;
  const char *at = text.data(), *end = at + text.size();
  struct Part {
    int* value;
    char after;
  };
  for (const auto& [value, after] : {Part{&r.x, ','}, Part{&r.y, ','}, Part{&r.width, 'x'}, Part{&r.height, '\0'}}) {
    const auto [stop, error] = std::from_chars(at, end, *value);
    const bool last = after == '\0';
    if (error != std::errc() || *value < 0 || (last ? stop != end : stop == end || *stop != after))
      throw std::runtime_error(fmt::format("--ignore '{}' is not X,Y,WIDTHxHEIGHT, such as 10,20,200x30", text));
    at = stop + !last;
  }
  return r;
}

CompareRequest request_of(const Options& options) {
  CompareRequest request{options.word, options.inputs.front(), {}, options.mask, {}, [] {
                           if (interrupted()) throw CompareStopped{};
                         }};
  std::vector<std::string_view> names;
  for (const render::ComparePreset& preset : render::compare_presets()) {
    names.push_back(preset.name);
    if (preset.name == options.preset) request.rule = preset.rule;
  }
  if (std::find(names.begin(), names.end(), options.preset) == names.end())
    throw std::runtime_error(
        fmt::format("'{}' is no preset{}", options.preset, sim::suggestion(options.preset, names)));
  render::visit(request.rule, [&](std::string_view name, std::string_view, double& value) {
    for (const auto& [given, limit] : options.limits)
      if (given == name) value = limit;
  });
  for (const std::string& text : options.ignore) request.ignored.push_back(rectangle_of(text));
  return request;
}

int compare_as_asked(const Options& options) {
  const CompareRequest request = request_of(options);
  if (!options.diff.empty()) check_difference_folder(request, options.diff);
  Comparisons made;
  {
    Progress progress("comparing", options.quiet);
    made = compare_pictures(request, [&](double share) { progress.show(share, "pictures"); });
  }
  std::vector<Comparison>& all = made.all;
  if (!options.diff.empty()) write_differences(request, all, options.diff);
  if (!options.html.empty()) write_page(request, all, options.html);
  if (!options.junit.empty()) write_junit(request, all, options.junit);
  const int status = exit_status(all);
  std::string text;
  if (options.json)
    text = report_json(request, all);
  else
    for (const Comparison& c : all)
      if (!options.quiet || c.verdict != Verdict::same) text += report_line(c) + "\n";
  int left = status;
  if (options.update) {
    const Accepted accepted = accept_pictures(request, all);
    if (!options.json)
      for (const std::string& line : accepted.done) text += printable(line) + "\n";
    for (const std::string& sentence : accepted.refused) tell(printable(sentence));
    left = exit_status(all);
  }
  if (!options.json && !options.quiet) text += report_totals(all) + "\n";
  if (!made.passed_over.empty()) tell(printable(made.passed_over));
  try {
    write_whole_file("-", text);
  } catch (const std::system_error& error) {
    // Where the reader has seen enough, the answer is the status.
    __fpurge(stdout);
    std::clearerr(stdout);
    if (error.code() != std::errc::broken_pipe) throw;
  }
  return left;
}

}  // namespace

int compare(const Options& options) {
  try {
    return compare_as_asked(options);
  } catch (const CompareStopped&) {
    tell("interrupted; there is no answer");
    return interrupted_status;
  } catch (const std::bad_alloc&) {
    tell("there is not enough memory");
  } catch (const std::exception& error) {
    tell(printable(error.what()));
  }
  return 2;
}

}  // namespace app
