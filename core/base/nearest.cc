#include "core/base/nearest.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace ricochet {
namespace {

// This bounds the time that a hostile text takes.
constexpr size_t kMostCharacters = 80;

// Returns the only path that ends in `name` after a dot; empty if there is none, or several.
std::string OnlyPathThatEndsIn(absl::string_view name, const std::vector<std::string>& known) {
  const std::string ending = absl::StrCat(".", name);
  std::string only;
  for (const std::string& path : known) {
    if (name.empty() || !absl::EndsWith(path, ending)) continue;
    if (!only.empty()) return "";
    only = path;
  }
  return only;
}

}  // namespace

// Computes the table of distances row by row.
size_t EditDistance(absl::string_view a, absl::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string NearestName(absl::string_view name, const std::vector<std::string>& known) {
  if (name.size() > kMostCharacters) return "";
  for (const std::string& path : {absl::StrCat(name, "[0]"), OnlyPathThatEndsIn(name, known)}) {
    if (std::find(known.begin(), known.end(), path) != known.end()) return path;
  }
  std::string nearest;
  size_t least = std::numeric_limits<size_t>::max();
  for (const std::string& candidate : known) {
    const size_t distance = EditDistance(name, candidate);
    // A name of which every letter differs is not near, however short it is.
    if (distance >= least || distance >= std::max(name.size(), candidate.size())) continue;
    const auto differ = std::mismatch(name.begin(), name.end(), candidate.begin(), candidate.end()).first;
    const auto rest = static_cast<size_t>(name.end() - differ);
    if (distance > std::max<size_t>(2, rest / 3)) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string DidYouMean(absl::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = NearestName(name, known);
  return nearest.empty() ? "" : absl::StrCat("; did you mean ", nearest, "?");
}

}  // namespace ricochet
