#include "client/cli/report/html_page.h"

#include <regex>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace ricochet::cli {
namespace {

// Returns `text` with the characters that HTML reserves as entities.
std::string HtmlText(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

// In the dark the pictures are inverted and their hues turned back, so that the colours of the lines stay.
constexpr char kStyle[] = R"(
:root { color-scheme: light dark; --page: #ffffff; --text: #1d1d1f; --quiet: #5f6368; --rule: #d9dce0;
  --stripe: #f5f6f8; --alarm: #b3261e; --mark: #0b6bcb; }
@media (prefers-color-scheme: dark) {
  :root { --page: #15171a; --text: #e6e7e9; --quiet: #a3a8ae; --rule: #363a40; --stripe: #1d2024; --alarm: #ff8a80;
    --mark: #7ab7ff; }
  figure svg { filter: invert(0.92) hue-rotate(180deg); }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--text); font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 24px 20px 64px; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 0.3em; }
h2 { font-size: 1.2rem; margin: 2.2em 0 0.6em; }
p, dd { max-width: 46em; }
.quiet { color: var(--quiet); }
.alarm { color: var(--alarm); font-weight: 600; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(220px, 1fr)); gap: 12px; padding: 0;
  margin: 24px 0; }
.facts li { list-style: none; border: 1px solid var(--rule); border-radius: 8px; padding: 12px 16px; }
.facts b { display: block; font-size: 1.25rem; }
figure { margin: 24px 0; }
figure svg { display: block; width: 100%; height: auto; }
figure svg rect[fill="#ffffff"] { fill: none; }
figure svg text, figure svg tspan { font-family: system-ui, "DejaVu Sans", sans-serif; }
figcaption { color: var(--quiet); font-size: 0.92rem; max-width: 50em; margin-top: 8px; }
.narrow { display: none; }
table { border-collapse: collapse; width: 100%; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
th, td { padding: 6px 10px; border-bottom: 1px solid var(--rule); text-align: right; vertical-align: top; }
th { font-weight: 600; vertical-align: bottom; }
th:first-child, td:first-child, .words th, .words td { text-align: left; }
tbody tr:nth-child(even) { background: var(--stripe); }
tr.front td:first-child { font-weight: 600; }
tr.front td:first-child::after { content: " ●"; color: var(--mark); }
td.time { white-space: nowrap; }
dt { font-weight: 600; margin-top: 0.8em; }
dd { margin: 0; }
pre { background: var(--stripe); border: 1px solid var(--rule); border-radius: 8px; padding: 12px 16px;
  overflow-x: auto; font: 0.85rem/1.45 ui-monospace, "DejaVu Sans Mono", monospace; }
@media (max-width: 700px) {
  main { padding: 16px 14px 48px; }
  h1 { font-size: 1.35rem; }
  .wide { display: none !important; }
  .narrow { display: block; }
  .cards thead { display: none; }
  .cards, .cards tbody, .cards tr, .cards td { display: block; width: 100%; }
  .cards tr { border: 1px solid var(--rule); border-radius: 8px; margin: 0 0 10px; padding: 8px 12px; }
  .cards td { border: 0; padding: 1px 0; display: flex; justify-content: space-between; gap: 12px; text-align: right; }
  .cards td:first-child { font-weight: 600; justify-content: flex-start; }
  .cards td:not(:first-child)::before { content: attr(data-label); color: var(--quiet); text-align: left; }
  .cards td:empty { display: none; }
}
)";

std::string HtmlRow(const std::vector<std::string>& cells, const std::string& name) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += HtmlElement(name, cell);
  return text + "</tr>";
}

}  // namespace

std::string HtmlElement(const std::string& name, const std::string& text, const std::string& attributes) {
  return absl::StrCat("<", name, attributes, ">", HtmlText(text), "</", name, ">");
}

std::string HtmlTable(const std::vector<std::vector<std::string>>& rows, const std::string& style_class) {
  std::string text =
      absl::StrCat("<table class=\"", style_class, "\">\n<thead>", HtmlRow(rows.front(), "th"), "</thead>\n<tbody>\n");
  for (size_t i = 1; i < rows.size(); ++i) absl::StrAppend(&text, HtmlRow(rows[i], "td"), "\n");
  return text + "</tbody>\n</table>\n";
}

std::string HtmlPage(const std::string& title, const std::string& body) {
  return absl::StrCat(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n",
      HtmlElement("title", title), "\n<style>", kStyle, "</style>\n</head>\n<body>\n<main>\n", body,
      "</main>\n</body>\n</html>\n");
}

std::string InlineSvg(const std::string& file, const std::string& prefix, const std::string& title) {
  const size_t start = file.find("<svg");
  const size_t end = file.find('>', start);
  if (start == std::string::npos || end == std::string::npos) return "";
  static const std::regex view_box_pattern(R"(viewBox="[^"]*")");
  std::smatch view_box;
  const std::string head = file.substr(start, end - start);
  std::regex_search(head, view_box, view_box_pattern);
  static const std::regex gnuplot_title(R"(<title>Gnuplot</title>|<desc>[^<]*</desc>)");
  const std::string body = std::regex_replace(file.substr(end + 1), gnuplot_title, "");
  return absl::StrCat("<svg ", view_box.str(), " role=\"img\"><title>", HtmlText(title), "</title>",
                      absl::StrReplaceAll(body, {{" id='", absl::StrCat(" id='", prefix)},
                                                 {" id=\"", absl::StrCat(" id=\"", prefix)},
                                                 {"xlink:href='#", absl::StrCat("href='#", prefix)},
                                                 {"url(#", absl::StrCat("url(#", prefix)}}));
}

}  // namespace ricochet::cli
