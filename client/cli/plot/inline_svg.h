// InlineSvg: makes a picture that gnuplot drew a part of an HTML page.

#ifndef RICOCHET_CLIENT_CLI_PLOT_INLINE_SVG_H_
#define RICOCHET_CLIENT_CLI_PLOT_INLINE_SVG_H_

#include <string>

namespace ricochet::cli {

// Returns the <svg> element of the SVG file `file`. It names no address, its ids start with `prefix`, it takes its size
// from the page, and a reader that cannot see it is told `title`.
std::string InlineSvg(const std::string& file, const std::string& prefix, const std::string& title);

// Returns `text` with the characters that HTML reserves as entities.
std::string HtmlText(const std::string& text);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_PLOT_INLINE_SVG_H_
