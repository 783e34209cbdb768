#include "client/cli/short_name.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "client/cli/field_table.h"
#include "core/scene/field.h"
#include "core/sweep/column.h"

namespace ricochet::cli {
namespace {

// Letters and flags whose field is called otherwise.
constexpr std::pair<const char*, const char*> kLetters[] = {
    {"mu", "friction.kinetic_coefficient"},  {"mu_static", "friction.static_coefficient"},
    {"omega", "pendulum.omega_minus_rad_s"}, {"mu-static", "friction.static_coefficient"},
    {"inertia", "pendulum.inertia_kg_m2"},   {"phi", "pendulum.phi_rad"},
};

// Returns "pendulum.a" for "pendulum.a_m", and "rates_after[0]" for "rates_after_rad_s[0]".
std::string WithoutUnit(const std::string& path) {
  const FieldInfo* info = FindFieldInfo(path);
  if (info == nullptr || info->unit.empty()) return path;
  const std::string ending = absl::StrCat(
      "_",
      absl::StrReplaceAll(absl::AsciiStrToLower(info->unit), {{"1/", "per_"}, {"/", "_"}, {" ", "_"}, {"²", "2"}}));
  const size_t index = absl::EndsWith(path, "]") ? path.rfind('[') : path.size();
  absl::string_view stem(path.data(), index);
  absl::ConsumeSuffix(&stem, ending);
  return absl::StrCat(stem, path.substr(index));
}

// True if `path` is `name`, or ends in it after a dot.
bool EndsIn(const std::string& path, const std::string& name) {
  return path == name || absl::EndsWith(path, absl::StrCat(".", name));
}

bool Contains(const std::vector<std::string>& known, const std::string& name) {
  return std::find(known.begin(), known.end(), name) != known.end();
}

}  // namespace

absl::StatusOr<std::string> FullName(const std::string& name, const std::vector<std::string>& known,
                                     const std::string& what) {
  if (name.empty() || Contains(known, name)) return name;
  for (const auto& [letter, path] : kLetters) {
    if (name == letter && Contains(known, path)) return path;
  }
  std::vector<std::string> meant;
  for (const std::string& path : known) {
    if (EndsIn(path, name) || EndsIn(WithoutUnit(path), name)) meant.push_back(path);
  }
  if (meant.empty()) return name;
  if (meant.size() == 1) return meant.front();
  return absl::InvalidArgumentError(
      absl::StrCat(what, " ", name, ": must name one of\n  ", absl::StrJoin(meant, "\n  ")));
}

absl::Status ExpandField(const Scene& scene, const std::string& what, std::string& path) {
  absl::StatusOr<std::string> full = FullName(path, FieldPaths(scene), what);
  if (!full.ok()) return full.status();
  path = *std::move(full);
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> FullColumns(const Scene& scene, const std::vector<std::string>& names) {
  const std::vector<std::string> known = Columns(scene);
  std::vector<std::string> columns;
  for (const std::string& text : names) {
    const std::string name(absl::StripAsciiWhitespace(text));
    if (absl::EndsWith(name, "*")) {
      const size_t before = columns.size();
      const absl::string_view start = absl::StripSuffix(name, "*");
      std::copy_if(known.begin(), known.end(), std::back_inserter(columns),
                   [start](const std::string& column) { return absl::StartsWith(column, start); });
      if (columns.size() > before) continue;
    }
    absl::StatusOr<std::string> full = FullName(name, known, "--column");
    if (!full.ok()) return full.status();
    columns.push_back(*std::move(full));
  }
  return columns;
}

}  // namespace ricochet::cli
