// HtmlPage: a page that needs nothing beside it, in the one style of all pages, with its pictures.

#ifndef RICOCHET_CLIENT_CLI_REPORT_HTML_PAGE_H_
#define RICOCHET_CLIENT_CLI_REPORT_HTML_PAGE_H_

#include <string>
#include <vector>

namespace ricochet::cli {

// Returns one element with a text, whose reserved characters become entities. `attributes` starts with a space unless
// it is empty.
std::string HtmlElement(const std::string& name, const std::string& text, const std::string& attributes = "");

// Returns a table of a class of the style; the first row is its head.
std::string HtmlTable(const std::vector<std::vector<std::string>>& rows, const std::string& style_class);

// Returns the whole page with `body` as its main part.
std::string HtmlPage(const std::string& title, const std::string& body);

// Returns the <svg> element of the SVG file `file`. It names no address, its ids start with `prefix`, it takes its size
// from the page, and a reader that cannot see it is told `title`.
std::string InlineSvg(const std::string& file, const std::string& prefix, const std::string& title);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_HTML_PAGE_H_
