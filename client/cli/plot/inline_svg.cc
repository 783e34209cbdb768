#include "client/cli/plot/inline_svg.h"

#include <regex>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace ricochet::cli {

std::string HtmlText(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
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
