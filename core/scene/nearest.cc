#include "core/scene/nearest.h"

#include <algorithm>
#include <numeric>

#include "absl/strings/str_cat.h"

namespace ricochet {
namespace {

// This bounds the time that a hostile text takes.
constexpr size_t kMostCharacters = 80;

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

std::string NearestHint(const std::string& text, const std::vector<std::string>& known) {
  if (known.empty() || text.size() > kMostCharacters) return "";
  std::vector<size_t> distances;
  distances.reserve(known.size());
  for (const std::string& name : known) distances.push_back(EditDistance(text, name));
  const auto nearest = std::min_element(distances.begin(), distances.end()) - distances.begin();
  return absl::StrCat("; the nearest is \"", known[static_cast<size_t>(nearest)], "\"");
}

}  // namespace ricochet
