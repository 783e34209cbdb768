// ricochet_describe: prints the options of both programs as JSON, from which the manual pages and the completions are
// made. It also prints the words that complete values: systems, effects, paths and columns. It is not installed.

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/synchronization/mutex.h"
#include "client/cli/input/file_option.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/scene_templates.h"
#include "client/cli/program.h"
#include "client/cli/report/plan_report.h"
#include "client/cli/text/enum_names.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "proto/wire/scene.h"
#include "ricochet/plan.h"
#include "server/options.h"

namespace {

using google::protobuf::ListValue;
using google::protobuf::Struct;

void Set(Struct& object, const std::string& name, const std::string& text) {
  (*object.mutable_fields())[name].set_string_value(text);
}

ListValue& List(Struct& object, const std::string& name) {
  return *(*object.mutable_fields())[name].mutable_list_value();
}

// Whether the value is the name of a file that is read or written.
std::string FileText(CLI::Option& option) {
  const std::optional<ricochet::cli::FileUse> use = ricochet::cli::FileUseOf(option);
  if (!use.has_value()) return "";
  return *use == ricochet::cli::FileUse::kRead ? "read" : "written";
}

void Describe(CLI::Option& option, Struct& object) {
  ListValue& names = List(object, "names");
  for (const std::string& name : option.get_snames()) names.add_values()->set_string_value("-" + name);
  for (const std::string& name : option.get_lnames()) names.add_values()->set_string_value("--" + name);
  const bool is_flag = option.get_type_size() == 0;
  const std::string value = option.get_option_text().empty() ? option.get_type_name() : option.get_option_text();
  Set(object, "value", is_flag ? "" : std::string(absl::StripAsciiWhitespace(value)));
  Set(object, "positional", option.get_positional() ? option.get_name(true) : "");
  Set(object, "description", option.get_description());
  Set(object, "group", option.get_group());
  Set(object, "file", FileText(option));
}

void Describe(CLI::App& app, Struct& object) {
  Set(object, "name", app.get_name());
  Set(object, "description", app.get_description());
  Set(object, "footer", app.get_footer());
  for (CLI::Option* option : app.get_options()) {
    Describe(*option, *List(object, "options").add_values()->mutable_struct_value());
  }
  // A command without a name groups options and is no command.
  for (CLI::App* sub : app.get_subcommands([](const CLI::App* any) { return !any->get_name().empty(); })) {
    Describe(*sub, *List(object, "commands").add_values()->mutable_struct_value());
  }
}

// Appends the words that are not there yet.
void AddNew(const std::vector<std::string>& words, std::vector<std::string>& all) {
  for (const std::string& word : words) {
    if (std::find(all.begin(), all.end(), word) == all.end()) all.push_back(word);
  }
}

void SetWords(Struct& object, const std::string& value, const std::vector<std::string>& words) {
  ListValue& list = List(object, value);
  for (const std::string& word : words) list.add_values()->set_string_value(word);
}

// Describes the words that may stand for each kind of value, by the name of the kind in the help. Paths and columns are
// those of the scenes of all templates together.
absl::Status DescribeValues(Struct& object) {
  std::vector<std::string> templates, paths, columns, effects;
  for (const ricochet::cli::SceneTemplate& one : ricochet::cli::SceneTemplates()) {
    ricochet::v1::Scene proto;
    if (absl::Status bad = ricochet::cli::ParseMessage("template.textproto", one.text, proto); !bad.ok()) return bad;
    const ricochet::Scene scene = ricochet::FromProto(proto);
    templates.push_back(one.system);
    AddNew(ricochet::FieldPaths(scene), paths);
    AddNew(ricochet::Columns(scene), columns);
  }
  for (const auto& one : ricochet::cli::MultiContactTemplates()) templates.push_back(one.system);
  for (int i = 1; i < ricochet::kEffectCount; ++i) {
    effects.push_back(ricochet::cli::EffectWord(static_cast<ricochet::Effect>(i)));
  }
  SetWords(object, "TEMPLATE", templates);
  SetWords(object, "EFFECT,...", effects);
  SetWords(object, "COLUMN,...", columns);
  SetWords(object, "PATH=VALUES", paths);
  SetWords(object, "PATH=LOW:HIGH", paths);
  return absl::OkStatus();
}

}  // namespace

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  Struct programs;
  ricochet::cli::Command command;
  Describe(*ricochet::cli::MakeProgram({"ricochet"}, command),
           *List(programs, "programs").add_values()->mutable_struct_value());
  Describe(*ricochet::server::MakeCommandLine(), *List(programs, "programs").add_values()->mutable_struct_value());
  if (!DescribeValues(*(*programs.mutable_fields())["values"].mutable_struct_value()).ok()) return 1;
  std::string text;
  if (!google::protobuf::util::MessageToJsonString(programs, &text).ok()) return 1;
  std::cout << text << '\n';
  return 0;
}
