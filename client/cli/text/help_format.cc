#include "client/cli/text/help_format.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "client/cli/text/wrap.h"

namespace ricochet::cli {
namespace {

constexpr size_t kHelpWidth = 80;
constexpr size_t kLongLine = 100;

std::string Wrap(const std::string& text, size_t indent, size_t start) {
  return WrapWords(text, kHelpWidth, start, indent);
}

// Lines that begin with two spaces are examples and stay as they are. The others are sentences: a line of more than
// kLongLine columns goes on in the next.
std::string WrapFooter(const std::string& footer) {
  std::string text;
  std::string sentences;
  const auto end_sentences = [&] { absl::StrAppend(&text, Wrap(std::exchange(sentences, ""), 0, 0), "\n"); };
  for (const absl::string_view line : absl::StrSplit(footer, '\n')) {
    if (absl::StartsWith(line, "  ")) {
      if (!sentences.empty()) end_sentences();
      absl::StrAppend(&text, line, "\n");
      continue;
    }
    absl::StrAppend(&sentences, sentences.empty() ? "" : " ", line);
    if (Characters(line) <= kLongLine) end_sentences();
  }
  if (!sentences.empty()) end_sentences();
  return text;
}

}  // namespace

std::string HelpFormat::Entry(const std::string& name, const std::string& description) const {
  const size_t indent = get_column_width();
  const std::string head = absl::StrCat("  ", name);
  if (description.empty()) return absl::StrCat(head, "\n");
  const size_t width = Characters(head);
  const std::string gap =
      width < indent ? std::string(indent - width, ' ') : absl::StrCat("\n", std::string(indent, ' '));
  return absl::StrCat(head, gap, Wrap(description, indent, indent), "\n");
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  return Entry(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
}

std::string HelpFormat::make_option_opts(const CLI::Option* option) const {
  std::string text = CLI::Formatter::make_option_opts(option);
  const std::string title = absl::StrCat(" ", get_label("Excludes"), ":");
  const size_t start = text.rfind(title);
  if (start == std::string::npos) return text;
  std::vector<std::string> names;
  for (const CLI::Option* other : option->get_excludes()) names.push_back(other->get_name());
  std::sort(names.begin(), names.end());
  return absl::StrCat(text.substr(0, start), title, " ", absl::StrJoin(names, " "));
}

std::string HelpFormat::make_subcommand(const CLI::App* sub) const {
  return Entry(sub->get_display_name(true), sub->get_description());
}

std::string HelpFormat::make_description(const CLI::App* app) const {
  return absl::StrCat(Wrap(app->get_description(), 0, 0), "\n");
}

std::string HelpFormat::make_footer(const CLI::App* app) const { return WrapFooter(app->get_footer()); }

}  // namespace ricochet::cli
