#include "client/cli/input/short_name.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "absl/algorithm/container.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "client/cli/text/field_table.h"
#include "core/base/derivative_name.h"
#include "core/base/nearest.h"
#include "core/base/try.h"
#include "core/rows/column.h"
#include "core/scene/field.h"

namespace ricochet::cli {
namespace {

// Letters and flags whose field is called otherwise.
constexpr std::pair<const char*, const char*> kLetters[] = {
    {"mu", "friction.kinetic_coefficient"},  {"mu_static", "friction.static_coefficient"},
    {"omega", "pendulum.omega_minus_rad_s"}, {"mu-static", "friction.static_coefficient"},
    {"inertia", "pendulum.inertia_kg_m2"},   {"phi", "pendulum.phi_rad"},
};

// True if `path` is `name`, or ends in it after a dot. Paths under "errors." and "free_end." end in the names of other
// numbers, so that the name alone never means them.
bool EndsIn(const std::string& path, const std::string& name) {
  return path == name || (absl::EndsWith(path, absl::StrCat(".", name)) && !absl::StartsWith(path, "errors.") &&
                          !absl::StartsWith(path, "free_end."));
}

// Returns the name itself, which the checks of a request will refuse, unless it is nearly the last part of a known
// name.
absl::StatusOr<std::string> NearShortName(const std::string& name, const std::vector<std::string>& known,
                                          const std::string& what) {
  const std::string lower = absl::AsciiStrToLower(name);
  const absl::StatusOr<std::string> meant = lower == name ? name : FullName(lower, known, what);
  if (meant.ok() && *meant != lower) {
    return absl::InvalidArgumentError(absl::StrCat(what, " ", name, ": names nothing; did you mean ", lower, "?"));
  }
  // A shorter name is near to too many endings to suggest one of them.
  constexpr size_t kLeast = 4;
  if (name.size() < kLeast || absl::StrContains(name, '.') || absl::StrContains(name, '*')) return name;
  std::vector<std::string> endings;
  for (const std::string& path : known) endings.push_back(WithoutUnit(path).substr(path.rfind('.') + 1));
  const std::string nearest = NearestName(name, endings);
  if (nearest.empty()) return name;
  const auto found = std::find(endings.begin(), endings.end(), nearest);
  return absl::InvalidArgumentError(absl::StrCat(what, " ", name, ": names nothing; did you mean ",
                                                 known[static_cast<size_t>(found - endings.begin())], "?"));
}

}  // namespace

absl::StatusOr<std::string> FullName(const std::string& name, const std::vector<std::string>& known,
                                     const std::string& what) {
  if (name.empty() || absl::c_linear_search(known, name)) return name;
  for (const auto& [letter, path] : kLetters) {
    if (name == letter && absl::c_linear_search(known, path)) return path;
  }
  std::vector<std::string> meant;
  for (const std::string& path : known) {
    if (EndsIn(path, name) || EndsIn(WithoutUnit(path), name)) meant.push_back(path);
  }
  if (meant.empty()) return NearShortName(name, known, what);
  if (meant.size() == 1) return meant.front();
  return absl::InvalidArgumentError(
      absl::StrCat(what, " ", name, ": must name one of\n  ", absl::StrJoin(meant, "\n  ")));
}

absl::StatusOr<std::string> FullField(const Scene& scene, const std::string& name, const std::string& what) {
  return FullName(name, AllFieldPaths(scene), what);
}

Spelling SpellingOf(const std::string& path) {
  const FieldInfo* const info = FindFieldInfo(path);
  // A path that is no field is refused by its name, whatever its values are.
  return info == nullptr || info->unit == "rad" ? Spelling::kAngle : Spelling::kNumber;
}

CellKind CellKindOf(const std::string& path) {
  return SpellingOf(path) == Spelling::kAngle ? CellKind::kAngle : CellKind::kNumber;
}

// Completes both names of a derivative: that of a number among `ofs`, and that of a field among `bys`.
static absl::StatusOr<std::string> FullDerivative(const DerivativeName& name, const std::vector<std::string>& ofs,
                                                  const std::vector<std::string>& bys) {
  RICOCHET_TRY(std::string of, FullName(name.of, ofs, "--column"));
  RICOCHET_TRY(std::string by, FullName(name.by, bys, "--column"));
  return DerivativeName{std::move(of), std::move(by)}.Text();
}

// Completes the names in a column that is a derivative.
static absl::StatusOr<std::string> FullDerivative(const DerivativeName& name, const std::vector<std::string>& known) {
  std::set<std::string> ofs, bys;
  for (const std::string& column : known) {
    const std::optional<DerivativeName> derivative = ReadDerivativeName(column);
    if (!derivative.has_value()) continue;
    ofs.insert(derivative->of);
    bys.insert(derivative->by);
  }
  return FullDerivative(name, {ofs.begin(), ofs.end()}, {bys.begin(), bys.end()});
}

absl::StatusOr<std::vector<std::string>> FullColumns(const Scene& scene, const std::vector<std::string>& names) {
  const std::vector<std::string> known = Columns(scene);
  const std::vector<std::string> places = ColumnPlaces(scene);
  std::vector<std::string> columns;
  for (const std::string& name : names) {
    if (name == "regime" || name == "status") {
      return absl::InvalidArgumentError(absl::StrCat(
          "--column ", name, ": is no number: sweep --regime prints regime and status, and solve --data always does"));
    }
    if (const auto derivative = ReadDerivativeName(absl::StripAsciiWhitespace(name))) {
      RICOCHET_TRY(std::string full, FullDerivative(*derivative, known, AllFieldPaths(scene)));
      columns.push_back(std::move(full));
      continue;
    }
    RICOCHET_TRY(auto full, FullColumns(known, places, {name}));
    std::move(full.begin(), full.end(), std::back_inserter(columns));
  }
  return columns;
}

absl::StatusOr<std::vector<std::string>> FullColumns(const std::vector<std::string>& known,
                                                     const std::vector<std::string>& places,
                                                     const std::vector<std::string>& names) {
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
    const std::optional<DerivativeName> derivative = ReadDerivativeName(name);
    RICOCHET_TRY(std::string full,
                 derivative.has_value() ? FullDerivative(*derivative, known) : FullName(name, places, "--column"));
    columns.push_back(std::move(full));
  }
  return columns;
}

}  // namespace ricochet::cli
