#include "app/compare/compare_report.h"

#include "app/base/markup.h"
#include "app/base/printable.h"
#include "app/base/version.h"
#include "app/scene/output.h"
#include "compare_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view our_mark = "tanktread compare";  // near the start of whatever is written
constexpr std::size_t page_limit = std::size_t{64} << 20;   // browsers grow slow beyond

std::int64_t count_of(const std::vector<Comparison>& all, Verdict verdict) {
  return std::count_if(all.begin(), all.end(), [verdict](const Comparison& c) { return c.verdict == verdict; });
}

bool was_compared(const Comparison& c) { return c.difference.compared > 0; }

/// What the objections have not said already.
std::string measures(const Comparison& c) {
  const render::ImageDifference& d = c.difference;
  std::string text = fmt::format("largest {:.4g}", d.maximum);
  if (c.detail.find("rmse") == std::string::npos) text += fmt::format(", rmse {:.3g}", d.rmse);
  if (d.flip_mean) text += fmt::format(", FLIP mean {:.3g}, largest {:.3g}", *d.flip_mean, *d.flip_max);
  if (d.above > 0) text += fmt::format(", at x {} to {}, y {} to {}", d.left, d.right - 1, d.top, d.bottom - 1);
  return text;
}

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string figure(std::string_view role, std::string_view caption, std::string_view bytes) {
  return fmt::format(
      "<figure><img class=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
      role, role, base64(bytes), caption);
}

/// The difference picture of a pair that could be compared; empty when a file has gone or changed since.
std::string difference_png(const CompareRequest& request, const Comparison& c) {
  try {
    const render::Image expected = render::read_png(c.expected).image, actual = render::read_png(c.actual).image;
    const render::Ignored ignored = ignored_pixels(request, c.mask, actual.width, actual.height);
    return render::png_bytes(render::difference_image(expected, actual, 16, ignored),
                             {{"Software", std::string(our_mark)}});
  } catch (const std::exception&) {
    return {};
  }
}

/// One picture's part of the page.
std::string article(const CompareRequest& request, const Comparison& c, std::size_t room) {
  std::string pictures;
  const auto add = [&](std::string_view role, std::string_view caption, const fs::path& path) {
    if (path.empty() || !fs::is_regular_file(path)) return;
    pictures += figure(role, caption, read_whole_file(path));
  };
  std::string expected = "expected";
  if (c.expected != c.baseline && !c.expected.empty())
    expected += " (" + markup_text(c.expected.filename().string()) + ")";
  if (c.verdict != Verdict::unreadable) {
    add("expected", expected, c.expected);
    add("actual", "actual", c.actual);
  }
  const bool pair = was_compared(c);
  if (pair)
    if (const std::string bytes = difference_png(request, c); !bytes.empty())
      pictures += figure("difference", "difference × 16", bytes);
  if (pictures.size() > room) pictures = "<p>Left out: the page would become too large.</p>\n";
  const std::string numbers = pair ? "; " + measures(c) : std::string();
  return fmt::format(
      "<article{}>\n<h2>{}</h2>\n<p><b class=\"{}\">{}</b> {}</p>\n<div class=\"pictures\">\n{}</div>\n</article>\n",
      pair ? " class=\"pair\"" : "", markup_text(c.name), words_of(c.verdict).name, words_of(c.verdict).name,
      markup_text(c.detail + numbers), pictures);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("cannot make folder '{}': {}", folder.string(), error.message()));
}

/// Is it a file that compare wrote?
bool is_ours(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string start(4096, '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  return start.find(our_mark) != std::string::npos;
}

/// Refuses what must not be replaced. Devices and pipes are written to as they are.
void check_place(const CompareRequest& request, const std::vector<Comparison>& all, const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return;
  const auto refuse_if_same = [&](const fs::path& compared) {
    if (!compared.empty() && fs::equivalent(path, compared, error))
      throw std::runtime_error(
          fmt::format("'{}' is one of the compared files, which a report must not replace", path.string()));
  };
  refuse_if_same(request.mask);
  for (const Comparison& c : all)
    for (const fs::path* compared : {&c.expected, &c.actual, &c.baseline, &c.mask}) refuse_if_same(*compared);
  if (fs::file_size(path, error) > 0 && !is_ours(path))
    throw std::runtime_error(fmt::format(
        "'{}' was not written by compare and is not replaced: remove it, or give another name", path.string()));
}

/// The same for a file in a folder of ours.
void write_into(const CompareRequest& request, const std::vector<Comparison>& all, const fs::path& folder,
                const fs::path& path, const std::string& bytes) {
  if (!stays_within(folder, path))
    throw std::runtime_error(fmt::format("a link leads from '{}' to somewhere else", path.string()));
  check_place(request, all, path);
  make_folder(path.parent_path());
  write_whole_file(path, bytes);
}

}  // namespace

std::string report_line(const Comparison& c) {
  std::string line = fmt::format("{:<10} {}", words_of(c.verdict).name, printable(c.name));
  if (!c.detail.empty()) line += "  " + printable(c.detail);
  if (was_compared(c)) line += fmt::format("{} {}", c.detail.empty() ? " " : ";", measures(c));
  if (c.verdict == Verdict::same && c.expected != c.baseline && !c.expected.empty())
    line += fmt::format("; as {}", printable(c.expected.filename().string()));
  return line;
}

std::string report_totals(const std::vector<Comparison>& all) {
  std::string text;
  for (const VerdictWords& w : verdict_words)
    if (const std::int64_t n = count_of(all, w.verdict); n > 0)
      text += fmt::format("{} {} {}", text.empty() ? "" : ",", n, w.name);
  return fmt::format("{} picture{}:{}", all.size(), all.size() == 1 ? "" : "s", text);
}

std::string report_json(const CompareRequest& request, const std::vector<Comparison>& all) {
  std::string rule, counts, pictures;
  const auto add = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  render::visit(request.rule, [&](std::string_view name, std::string_view, const double& value) {
    add(rule, fmt::format("{}: {}", json_text(name), json_number(value)));
  });
  for (const VerdictWords& w : verdict_words)
    add(counts, fmt::format("{}: {}", json_text(w.name), count_of(all, w.verdict)));
  for (const Comparison& c : all) {
    std::string fields;
    const auto field = [&](const char* name, const std::string& value) {
      add(fields, fmt::format("\"{}\": {}", name, value));
    };
    field("name", json_text(c.name));
    field("verdict", json_text(words_of(c.verdict).name));
    field("detail", json_text(c.detail));
    field("expected", c.expected.empty() ? "null" : json_text(c.expected.string()));
    field("actual", c.actual.empty() ? "null" : json_text(c.actual.string()));
    if (was_compared(c)) {
      const render::ImageDifference& d = c.difference;
      field("compared", std::to_string(d.compared));
      field("above", std::to_string(d.above));
      field("maximum", json_number(d.maximum));
      field("rmse", json_number(d.rmse));
      field("box", d.above > 0 ? fmt::format("[{}, {}, {}, {}]", d.left, d.top, d.right, d.bottom) : "null");
      if (d.flip_mean) field("flip_mean", json_number(*d.flip_mean));
      if (d.flip_max) field("flip_max", json_number(*d.flip_max));
    }
    pictures += fmt::format("{}    {{{}}}", pictures.empty() ? "" : ",\n", fields);
  }
  return fmt::format(
      "{{\n  \"program\": {},\n  \"expected\": {},\n  \"actual\": {},\n  \"rule\": {{{}}},\n  \"status\": {},\n"
      "  \"counts\": {{{}}},\n  \"pictures\": [\n{}\n  ]\n}}\n",
      json_text("tanktread " + version()), json_text(request.expected.string()), json_text(request.actual.string()),
      rule, exit_status(all), counts, pictures);
}

std::string report_junit(const std::vector<Comparison>& all) {
  std::int64_t failures = 0, errors = 0;
  std::string cases;
  for (const Comparison& c : all) {
    const VerdictWords& words = words_of(c.verdict);
    cases += fmt::format("    <testcase classname=\"tanktread.compare\" name=\"{}\" time=\"0\"", markup_text(c.name));
    if (words.status == 0) {
      cases += "/>\n";
      continue;
    }
    const char* element = words.status == 1 ? "failure" : "error";
    ++(words.status == 1 ? failures : errors);
    cases += fmt::format(">\n      <{} type=\"{}\" message=\"{}\">{}</{}>\n    </testcase>\n", element, words.name,
                         markup_text(c.detail), markup_text(report_line(c)), element);
  }
  const std::string counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", all.size(), failures, errors);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite name=\"tanktread compare\" {} "
      "skipped=\"0\" time=\"0\">\n{}  </testsuite>\n</testsuites>\n",
      counts, counts, cases);
}

void check_difference_folder(const CompareRequest& request, const fs::path& folder) {
  for (const fs::path* compared : {&request.expected, &request.actual})
    if (fs::is_directory(*compared) && stays_within(*compared, fs::weakly_canonical(folder) / "x"))
      throw std::runtime_error(fmt::format("--diff '{}' lies in '{}', whose pictures are compared: give another folder",
                                           folder.string(), compared->string()));
}

void write_differences(const CompareRequest& request, const std::vector<Comparison>& all, const fs::path& folder) {
  make_folder(folder);
  for (const Comparison& c : all) {
    if (request.look) request.look();
    if (c.verdict != Verdict::different) continue;
    write_into(request, all, folder, folder / c.name, difference_png(request, c));
  }
}

void write_junit(const CompareRequest& request, const std::vector<Comparison>& all, const fs::path& file) {
  check_place(request, all, file);
  write_whole_file(file, report_junit(all));
}

void write_page(const CompareRequest& request, const std::vector<Comparison>& all, const fs::path& folder) {
  make_folder(folder);
  std::vector<const Comparison*> order;
  for (const Comparison& c : all)
    if (c.verdict != Verdict::same) order.push_back(&c);
  // Differences first, the largest in front; then what could not be compared.
  std::stable_sort(order.begin(), order.end(), [](const Comparison* a, const Comparison* b) {
    return std::pair(a->verdict, -a->difference.rmse) < std::pair(b->verdict, -b->difference.rmse);
  });
  std::string articles, equal;
  for (const Comparison* c : order) {
    if (request.look) request.look();
    articles += article(request, *c, page_limit - std::min(page_limit, articles.size()));
  }
  for (const Comparison& c : all)
    if (c.verdict == Verdict::same)
      equal += fmt::format("<li>{} <small>{}</small></li>\n", markup_text(c.name), was_compared(c) ? measures(c) : "");
  if (!equal.empty())
    equal = fmt::format("<details><summary>{} the same</summary>\n<ul>\n{}</ul>\n</details>\n",
                        count_of(all, Verdict::same), equal);
  std::string rule;
  render::visit(request.rule, [&](std::string_view name, std::string_view meaning, const double& value) {
    if (std::isfinite(value) && (name != "ppd" || std::isfinite(std::min({request.rule.flip_mean, request.rule.flip_max,
                                                                          request.rule.flip_spot}))))
      rule += fmt::format("<tr><td>{}</td><td>{:g}</td><td>{}</td></tr>\n", name, value, meaning);
  });
  const std::string page = filled(compare_page, {{"totals", report_totals(all)},
                                                 {"expected", markup_text(request.expected.string())},
                                                 {"actual", markup_text(request.actual.string())},
                                                 {"program", "tanktread " + version()},
                                                 {"rule", rule},
                                                 {"equal", equal},
                                                 {"articles", articles}});
  write_into(request, all, folder, folder / "index.html", page);
}

}  // namespace app
