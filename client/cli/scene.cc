#include "proto/wire/scene.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/text_format.h>

#include <CLI/App.hpp>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/input/scene_templates.h"
#include "client/cli/program.h"
#include "client/cli/report/scene_schema.h"
#include "client/cli/text/field_table.h"
#include "client/cli/text/json_text.h"
#include "client/cli/text/table.h"
#include "core/base/nearest.h"
#include "core/rows/column.h"
#include "core/scene/field.h"
#include "core/scene/validate.h"
#include "core/scene/validate_multi.h"
#include "proto/comments/commented_protos.h"
#include "proto/wire/multi_contact.h"
#include "ricochet/error.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] = R"(Example: a scene of your own, from a template.
  $ ricochet scene template planar_contact | grep friction
  friction { kinetic_coefficient: 0.7 }
Then: ricochet scene template planar_contact -o my.textproto, edit it, and ricochet solve --scene my.textproto.
Exit codes: 0 done, 2 wrong input.)";

struct SceneCommand {
  CommonOptions common;
  SceneOptions scene;
  std::string system;
  bool several_contacts = false;

  bool json() const { return common.format == Format::kJson; }
};

absl::Status Write(const SceneCommand& options, const std::string& text) { return WriteOutput(options.common, text); }

// --- list, template, print, schema ---

std::string CommentOfSystem(const std::string& system) {
  const auto* scene = CommentedProtos().FindMessageTypeByName("ricochet.v1.Scene");
  return CommentOf(*scene->FindFieldByName(system));
}

// The comment at the start of a template, without its marks.
std::string FirstComment(const std::string& text) {
  std::string comment;
  for (const absl::string_view line : absl::StrSplit(text, '\n')) {
    if (!absl::StartsWith(line, "# ")) break;
    absl::StrAppend(&comment, comment.empty() ? "" : " ", line.substr(2));
  }
  return comment;
}

absl::Status RunList(const SceneCommand& options) {
  Table table(Table::Align::kLeft);
  std::string json = "[";
  const auto add = [&](const std::string& name, const std::string& comment, bool is_multi_contact) {
    table.Add({name, comment});
    absl::StrAppend(&json, json.size() > 1 ? "," : "", "{",
                    JsonMember(is_multi_contact ? "multicontact" : "system", name), ",", JsonMember("meaning", comment),
                    "}");
  };
  for (const SceneTemplate& one : SceneTemplates()) add(one.system, CommentOfSystem(one.system), false);
  table.Add({""});
  for (const SceneTemplate& one : MultiContactTemplates()) add(one.system, FirstComment(one.text), true);
  return Write(options, options.json() ? json + "]\n" : table.Render(0));
}

// Returns the scene as JSON or textproto.
std::string SceneText(const google::protobuf::Message& scene, bool json) {
  if (json) return SparseJsonOf(scene);
  std::string text;
  google::protobuf::TextFormat::PrintToString(scene, &text);
  return text;
}

absl::Status WriteTemplate(const SceneCommand& options, const std::string& text, google::protobuf::Message& scene) {
  if (!options.json()) return Write(options, text);
  if (absl::Status parsed = ParseMessage("template.textproto", text, scene); !parsed.ok()) return parsed;
  return Write(options, SceneText(scene, /*json=*/true));
}

absl::Status RunTemplate(const SceneCommand& options) {
  std::vector<std::string> systems;
  v1::Scene scene;
  v1::MultiContactScene several;
  for (const SceneTemplate& one : SceneTemplates()) {
    if (one.system == options.system) return WriteTemplate(options, one.text, scene);
    systems.push_back(one.system);
  }
  for (const SceneTemplate& one : MultiContactTemplates()) {
    if (one.system == options.system) return WriteTemplate(options, one.text, several);
    systems.push_back(one.system);
  }
  return absl::InvalidArgumentError(absl::StrCat(options.system, " is not a system",
                                                 DidYouMean(options.system, systems),
                                                 "\nSystems: ", absl::StrJoin(systems, ", ")));
}

std::vector<Violation> Check(const Scene& scene) { return Validate(scene, RestitutionIs::kOptional); }

std::vector<Violation> Check(const MultiContactScene& scene) {
  std::optional<MultiReduction> reduction;
  return Validate({.scene = scene}, reduction);
}

absl::Status RunPrint(const SceneCommand& options) {
  std::variant<Scene, MultiContactScene> scene;
  if (absl::Status status = ReadAnyScene(options.scene, scene); !status.ok()) return status;
  const auto print = [&options](const auto& its_scene) -> absl::Status {
    const std::vector<Violation> violations = Check(its_scene);
    if (!violations.empty()) return InvalidRequest(violations);
    return Write(options, SceneText(ToProto(its_scene), options.json()));
  };
  return std::visit(print, scene);
}

// --- fields and columns ---

std::string InfoJson(const std::string& path, const FieldInfo& info) {
  return absl::StrCat("{", JsonMember("path", path), ",", JsonMember("unit", info.unit), ",",
                      JsonMember("range", info.range), ",", JsonMember("meaning", info.meaning), ",",
                      JsonMember("description", info.comment), "}");
}

// Each path with its unit, and what it is on the line below.
absl::Status ListPaths(const SceneCommand& options, const std::vector<std::string>& paths) {
  std::string text;
  std::string json = "[";
  for (const std::string& path : paths) {
    const FieldInfo* info = FindFieldInfo(path);
    if (info == nullptr) return absl::InternalError(absl::StrCat("no description of ", path));
    absl::StrAppend(&json, json.size() > 1 ? ",\n" : "\n", InfoJson(path, *info));
    absl::StrAppend(&text, path, info->unit.empty() ? "" : absl::StrCat("  [", info->unit, "]"), "\n",
                    Wrapped(info->comment, 4));
  }
  return Write(options, options.json() ? json + "\n]\n" : text);
}

std::vector<std::string> PathsOf(const std::vector<FieldInfo>& table) {
  std::vector<std::string> paths;
  for (const FieldInfo& info : table) paths.push_back(info.path);
  return paths;
}

absl::Status RunFields(const SceneCommand& options) {
  if (!options.scene.any()) return ListPaths(options, PathsOf(SceneFieldTable()));
  const absl::StatusOr<Scene> scene = ReadScene(options.scene);
  return scene.ok() ? ListPaths(options, FieldPaths(*scene)) : scene.status();
}

absl::Status RunColumns(const SceneCommand& options) {
  if (!options.scene.any()) return ListPaths(options, Columns({.system = Pendulum()}));
  const absl::StatusOr<Scene> scene = ReadScene(options.scene);
  return scene.ok() ? ListPaths(options, Columns(*scene)) : scene.status();
}

constexpr std::array kListFormats = {Format::kText, Format::kJson};
constexpr std::array kSceneFormats = {Format::kTextproto, Format::kJson};
constexpr std::array kSchemaFormats = {Format::kJson};

using Run = absl::Status (*)(const SceneCommand&);

// Adds `ricochet scene NAME`, which sets the command to `run`.
std::pair<CLI::App*, SceneCommand*> AddOne(CLI::App& scene, const char* name, const char* help, Run run,
                                           absl::Span<const Format> formats, Command& command) {
  const auto [sub, options] = AddCommand<SceneCommand>(scene, name, help, kExample, run, command);
  CommonOptions& common = options->common;
  if (formats.size() > 1) {
    const auto choose_json = [&common] {
      common.format = Format::kJson;
      common.named_format = FormatName(common.format);
    };
    sub->add_flag_callback("--json", choose_json, "The same as --format json");
  }
  AddOutputOptions(*sub, common, formats);
  if (formats.size() > 1) sub->get_option("--json")->excludes(sub->get_option("--format"));
  return {sub, options};
}

}  // namespace

void AddScene(CLI::App& app, Command& command) {
  CLI::App* scene = app.add_subcommand("scene", "Show what scenes look like: templates, schema, fields, columns");
  scene->require_subcommand(1);
  scene->footer(kExample);
  const auto add = [&](const char* name, const char* help, Run run, absl::Span<const Format> formats) {
    return AddOne(*scene, name, help, run, formats, command);
  };
  add("list", "List the systems that can strike", RunList, kListFormats);
  const auto [one, one_options] = add("template", "Print a commented scene to start from", RunTemplate, kSceneFormats);
  one->add_option("TEMPLATE", one_options->system, "A name of `ricochet scene list`")->required();
  const auto [print, print_options] = add("print", "Print the scene of a file or of flags", RunPrint, kSceneFormats);
  AddAnySceneOptions(*print, print_options->scene);
  const auto [schema, schema_options] = add(
      "schema", "Print the JSON Schema of a scene, draft 2020-12",
      [](const SceneCommand& all) {
        return Write(all, all.several_contacts ? MultiContactSceneSchema() : SceneSchema());
      },
      kSchemaFormats);
  schema->add_flag("--multicontact", schema_options->several_contacts, "That of a scene with several contacts");
  const auto [fields, fields_options] =
      add("fields", "List the numbers of a scene with units, ranges and meanings", RunFields, kListFormats);
  AddSceneOptions(*fields, fields_options->scene);
  const auto [columns, columns_options] = add(
      "columns",
      "List the numbers of an answer, with the equations of the paper in brackets; without a scene those of a pendulum",
      RunColumns, kListFormats);
  AddSceneOptions(*columns, columns_options->scene);
}

}  // namespace ricochet::cli
