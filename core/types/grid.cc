#include "core/types/grid.h"

#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "core/base/counted.h"
#include "core/base/invariant.h"
#include "core/base/utf8.h"

namespace ricochet {
namespace {

// Indices beyond 2^53 would not be exact as doubles.
constexpr int64_t kMaxPoints = int64_t{1} << 53;

std::string AxisPath(size_t i, const char* field) { return absl::StrCat("axes[", i, "].", field); }

void CheckFinite(const std::string& path, double value, std::vector<Violation>& violations) {
  if (!std::isfinite(value)) violations.push_back(MakeViolation(path, value, "be finite"));
}

void CheckCount(const std::string& path, int64_t count, std::vector<Violation>& violations) {
  if (count >= 1 && count <= kMaxPoints) return;
  violations.push_back(MakeViolation(path, absl::StrCat("= ", count), "be in [1, 2^53]"));
}

void CheckValues(size_t i, std::monostate /*unset*/, std::vector<Violation>& violations) {
  violations.push_back(MakeViolation(AxisPath(i, "values"), "is not set", "be one of list, linspace, logspace"));
}

void CheckValues(size_t i, const ListValues& list, std::vector<Violation>& violations) {
  if (list.values.empty()) {
    violations.push_back(MakeViolation(AxisPath(i, "list.values"), "is empty", "have at least one value"));
  }
  for (size_t k = 0; k < list.values.size() && !IsFull(violations); ++k) {
    if (std::isfinite(list.values[k])) continue;
    CheckFinite(absl::StrCat(AxisPath(i, "list.values["), k, "]"), list.values[k], violations);
  }
}

void CheckValues(size_t i, const Linspace& linspace, std::vector<Violation>& violations) {
  CheckFinite(AxisPath(i, "linspace.start"), linspace.start, violations);
  CheckFinite(AxisPath(i, "linspace.stop"), linspace.stop, violations);
  CheckCount(AxisPath(i, "linspace.count"), linspace.count, violations);
}

void CheckValues(size_t i, const Logspace& logspace, std::vector<Violation>& violations) {
  const auto check_end = [&](const char* field, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    violations.push_back(MakeViolation(AxisPath(i, field), value, "be finite and > 0"));
  };
  check_end("logspace.start", logspace.start);
  check_end("logspace.stop", logspace.stop);
  CheckCount(AxisPath(i, "logspace.count"), logspace.count, violations);
}

// Finds why axes that are each valid by themselves make no grid. Their paths are text of the caller, which is escaped,
// and cut if it is long.
std::optional<Violation> CheckCombination(const Grid& grid) {
  switch (grid.combination) {
    case Combination::kZip:
      for (const Axis& axis : grid.axes) {
        if (AxisCount(axis) == AxisCount(grid.axes.front())) continue;
        return MakeViolation(
            "axes",
            absl::StrCat("have ", Counted(AxisCount(grid.axes.front()), "value"), " of ",
                         Excerpt(grid.axes.front().path), " and ", AxisCount(axis), " of ", Excerpt(axis.path)),
            "be equally long to be zipped");
      }
      return std::nullopt;
    case Combination::kUnspecified:
    case Combination::kProduct: {
      int64_t product = 1;
      for (const Axis& axis : grid.axes) {
        if (AxisCount(axis) > kMaxPoints / product) {
          return MakeViolation("axes", "multiply to more than 2^53 points", "be at most that many");
        }
        product *= AxisCount(axis);
      }
      return std::nullopt;
    }
  }
  return MakeViolation("combination", absl::StrCat("= ", static_cast<int>(grid.combination)),
                       "be COMBINATION_PRODUCT (1) or COMBINATION_ZIP (2)");
}

int64_t CountOf(std::monostate /*unset*/) { return 0; }
int64_t CountOf(const ListValues& list) { return static_cast<int64_t>(list.values.size()); }
int64_t CountOf(const Linspace& linspace) { return linspace.count; }
int64_t CountOf(const Logspace& logspace) { return logspace.count; }

}  // namespace

std::vector<Violation> ValidateAxes(const Grid& grid) {
  std::vector<Violation> violations;
  for (size_t i = 0; i < grid.axes.size() && !IsFull(violations); ++i) {
    std::visit([&](const auto& values) { CheckValues(i, values, violations); }, grid.axes[i].values);
  }
  if (!violations.empty()) return violations;
  if (const auto violation = CheckCombination(grid)) violations.push_back(*violation);
  return violations;
}

std::vector<std::string> AxisPaths(const Grid& grid) {
  std::vector<std::string> paths;
  for (const Axis& axis : grid.axes) paths.push_back(axis.path);
  return paths;
}

int64_t AxisCount(const Axis& axis) {
  return std::visit([](const auto& values) { return CountOf(values); }, axis.values);
}

int64_t PointCount(const Grid& grid) {
  if (grid.combination == Combination::kZip) {
    return grid.axes.empty() ? 1 : AxisCount(grid.axes.front());
  }
  int64_t product = 1;
  for (const Axis& axis : grid.axes) product *= AxisCount(axis);
  return product;
}

void AxisPositions(const Grid& grid, int64_t index, absl::Span<int64_t> positions) {
  for (size_t k = grid.axes.size(); k-- > 0;) {
    if (grid.combination == Combination::kZip) {
      positions[k] = index;
      continue;
    }
    const int64_t count = AxisCount(grid.axes[k]);
    CheckInvariant(count > 0, "an axis of a valid grid has values");
    positions[k] = index % count;
    index /= count;
  }
}

}  // namespace ricochet
