// HelpFormat: the text of --help, within 80 columns.

#ifndef RICOCHET_CLIENT_CLI_TEXT_HELP_FORMAT_H_
#define RICOCHET_CLIENT_CLI_TEXT_HELP_FORMAT_H_

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <cstddef>
#include <string>

namespace ricochet::cli {

inline constexpr size_t kHelpWidth = 80;

// Returns `text` in lines of at most kHelpWidth columns, all but the first indented by `indent`; the first begins at
// the column `start`. Words are never broken.
std::string Wrap(const std::string& text, size_t indent, size_t start);

// Returns a footer in lines of at most kHelpWidth columns. Lines that begin with two spaces are examples and stay as
// they are. The others are sentences: a line of more than 100 columns goes on in the next.
std::string WrapFooter(const std::string& footer);

class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  // Names the options that exclude this one in the order of the alphabet. CLI11 names them in the order of their
  // addresses, which differs from run to run.
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* sub) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;

 private:
  std::string Entry(const std::string& name, const std::string& description) const;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_HELP_FORMAT_H_
