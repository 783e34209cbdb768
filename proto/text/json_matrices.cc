#include "proto/text/json_matrices.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "core/base/try.h"
#include "proto/text/json_errors.h"
#include "ricochet/contact_matrix.h"

namespace ricochet {
namespace {

constexpr char kBlanks[] = " \t\r\n";

constexpr absl::string_view kPackedW = "w_per_kg", kMass = "mass_matrix", kJacobian = "jacobian";
// The systems that state a W: by its upper triangle, or all entries of that of several contacts.
constexpr absl::string_view kPlanar = "planar_contact", kSpatial = "spatial_contact", kSeveral = "contact_matrix";

// The rows of a matrix and where its text begins and ends.
struct Matrix {
  size_t begin = 0, end = 0;
  std::vector<std::vector<double>> rows;
};

// Names the first number of a matrix that no double holds.
absl::Status CheckNumbers(absl::string_view key, absl::string_view text) {
  for (const absl::string_view number : absl::StrSplit(text, absl::ByAnyChar("[], \t\r\n"), absl::SkipEmpty())) {
    const std::string rule = WhyNoDouble(number);
    if (!rule.empty()) return absl::InvalidArgumentError(absl::StrCat(key, " has ", number, ": must ", rule));
  }
  return absl::OkStatus();
}

// Reads the value of the key that ends before `at`, if it is a list of lists of numbers.
absl::StatusOr<std::optional<Matrix>> MatrixAt(const std::string& text, absl::string_view key, size_t at) {
  Matrix matrix;
  const size_t colon = text.find_first_not_of(kBlanks, at);
  if (colon == std::string::npos || text[colon] != ':') return std::optional<Matrix>();
  matrix.begin = text.find_first_not_of(kBlanks, colon + 1);
  if (matrix.begin == std::string::npos || text[matrix.begin] != '[') return std::optional<Matrix>();
  int depth = 0;
  for (matrix.end = matrix.begin; matrix.end < text.size(); ++matrix.end) {
    if (text[matrix.end] == '[') ++depth;
    if (text[matrix.end] == ']' && --depth == 0) break;
  }
  if (matrix.end++ >= text.size()) return std::optional<Matrix>();
  const absl::string_view value(text.data() + matrix.begin, matrix.end - matrix.begin);
  if (absl::Status status = CheckNumbers(key, value); !status.ok()) return status;
  const auto json = nlohmann::json::parse(value, nullptr, false);
  if (!json.is_array() || json.empty()) return std::optional<Matrix>();
  for (const nlohmann::json& row : json) {
    const bool is_row =
        row.is_array() && std::all_of(row.begin(), row.end(), [](const auto& x) { return x.is_number(); });
    if (!is_row) return std::optional<Matrix>();
    matrix.rows.push_back(row.get<std::vector<double>>());
  }
  return std::optional(std::move(matrix));
}

// The shortest decimals that read back as the same doubles.
std::string ListOf(const std::vector<double>& values) { return nlohmann::json(values).dump(); }

absl::StatusOr<std::string> PackedW(const Matrix& matrix, const std::vector<double>& w, bool in_space) {
  const size_t rows = in_space ? 3 : 2;
  if (matrix.rows.size() != rows || w.size() != rows * rows) {
    return absl::InvalidArgumentError(absl::StrCat("w_per_kg has ", w.size(), " entries: must be ", rows, " x ", rows,
                                                   " in a ", in_space ? kSpatial : kPlanar));
  }
  if (in_space) {
    RICOCHET_TRY(const auto contact, ContactFrom(std::span<const double, 9>(w.data(), 9), {0.0, 0.0}, 0.0));
    return absl::StrCat("\"w_per_kg\": ", ListOf(contact.w_per_kg));
  }
  RICOCHET_TRY(const auto contact, ContactFrom(std::span<const double, 4>(w.data(), 4), 0.0, 0.0));
  const auto number = [](double x) { return nlohmann::json(x).dump(); };
  return absl::StrCat("\"w_tt_per_kg\": ", number(contact.w_tt_per_kg),
                      ", \"w_tn_per_kg\": ", number(contact.w_tn_per_kg),
                      ", \"w_nn_per_kg\": ", number(contact.w_nn_per_kg));
}

// Returns the system that states a W and begins last before `at`; a contact in space if there is none.
absl::string_view SystemBefore(const std::string& text, size_t at) {
  absl::string_view last = kSpatial;
  size_t begin = 0;
  for (const absl::string_view system : {kPlanar, kSpatial, kSeveral}) {
    const size_t found = text.rfind(absl::StrCat("\"", system, "\""), at);
    if (found != std::string::npos && found >= begin) begin = found, last = system;
  }
  return last;
}

// The number of rates that the text states; nothing if it states none.
std::optional<size_t> CountRates(const std::string& text) {
  const std::string rates = "\"rates\"";
  for (size_t at = text.find(rates); at != std::string::npos; at = text.find(rates, at + 1)) {
    const size_t begin = text.find_first_not_of(absl::StrCat(kBlanks, ":"), at + rates.size());
    const size_t end = text.find(']', at);
    if (begin == std::string::npos || text[begin] != '[' || end == std::string::npos) continue;
    const auto json = nlohmann::json::parse(text.begin() + static_cast<ptrdiff_t>(begin),
                                            text.begin() + static_cast<ptrdiff_t>(end) + 1, nullptr, false);
    if (json.is_array()) return json.size();
  }
  return std::nullopt;
}

// A matrix of a mechanism has a column for each rate: one that is written down transposed would be read as another.
absl::Status CheckColumns(const std::string& text, absl::string_view key, const Matrix& matrix) {
  const std::optional<size_t> rates = CountRates(text);
  const size_t columns = matrix.rows.front().size();
  if (!rates.has_value() || columns == *rates) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("mechanism.", key, " has rows of ", columns,
                                                 " entries: must have rows of ", *rates, ", one for each of rates"));
}

absl::StatusOr<std::string> FlatText(const std::string& text, absl::string_view key, size_t key_at,
                                     const Matrix& matrix) {
  std::vector<double> entries;
  for (const std::vector<double>& row : matrix.rows) {
    if (row.size() != matrix.rows.front().size()) {
      return absl::InvalidArgumentError(absl::StrCat(key, " has rows of ", matrix.rows.front().size(), " and of ",
                                                     row.size(), " entries: must have rows of one length"));
    }
    entries.insert(entries.end(), row.begin(), row.end());
  }
  if (key != kPackedW) {
    if (absl::Status status = CheckColumns(text, key, matrix); !status.ok()) return status;
  }
  const absl::string_view system = SystemBefore(text, key_at);
  if (key == kPackedW && system == kSeveral && matrix.rows.size() != matrix.rows.front().size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("w_per_kg is ", matrix.rows.size(), " x ", matrix.rows.front().size(), ": must be square"));
  }
  if (key == kPackedW && system != kSeveral) return PackedW(matrix, entries, system == kSpatial);
  return absl::StrCat("\"", key, "\": ", ListOf(entries));
}

}  // namespace

absl::StatusOr<std::string> WithFlatMatrices(const std::string& text) {
  std::string flat = text;
  for (const absl::string_view key : {kPackedW, kMass, kJacobian}) {
    const std::string quoted = absl::StrCat("\"", key, "\"");
    for (size_t at = flat.find(quoted); at != std::string::npos; at = flat.find(quoted, at + quoted.size())) {
      RICOCHET_TRY(const std::optional<Matrix> found, MatrixAt(flat, key, at + quoted.size()));
      if (!found.has_value()) {
        if (key == kPackedW && SystemBefore(flat, at) == kPlanar) {
          return absl::InvalidArgumentError("planar_contact.w_per_kg: must be a 2 x 2 matrix, a list of its rows");
        }
        continue;
      }
      const Matrix& matrix = *found;
      RICOCHET_TRY(std::string entry, FlatText(flat, key, at, matrix));
      const auto first = flat.begin() + static_cast<ptrdiff_t>(at);
      const auto lines = std::count(first, flat.begin() + static_cast<ptrdiff_t>(matrix.end), '\n');
      flat.replace(at, matrix.end - at, entry + std::string(static_cast<size_t>(lines), '\n'));
    }
  }
  return flat;
}

}  // namespace ricochet
