// HelpFormat: the text of --help, within 80 columns.

#ifndef RICOCHET_CLIENT_CLI_TEXT_HELP_FORMAT_H_
#define RICOCHET_CLIENT_CLI_TEXT_HELP_FORMAT_H_

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <string>

namespace ricochet::cli {

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
