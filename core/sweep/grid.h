// Grid: a base scene and the axes that drive it; index i <-> the values of every axis.
//
// kProduct: every combination, the last axis runs fastest. kZip: the axes advance together and are equally long.
// Nothing is stored per point, so a grid of 10^9 points costs what one of 10 does.

#ifndef RICOCHET_CORE_SWEEP_GRID_H_
#define RICOCHET_CORE_SWEEP_GRID_H_

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "absl/types/span.h"
#include "core/error.h"
#include "core/scene/scene.h"

namespace ricochet {

struct ListValues {
  std::vector<double> values;  // At least one.
  friend bool operator==(const ListValues&, const ListValues&) = default;
};

// `count` values from `start` to `stop`, both ends exact, evenly spaced. count = 1 is `start`.
struct Linspace {
  double start = 0.0;
  double stop = 0.0;
  int64_t count = 0;  // >= 1
  friend bool operator==(const Linspace&, const Linspace&) = default;
};

// `count` values from `start` to `stop`, both > 0 and exact, evenly spaced in their logarithm.
struct Logspace {
  double start = 0.0;
  double stop = 0.0;
  int64_t count = 0;  // >= 1
  friend bool operator==(const Logspace&, const Logspace&) = default;
};

struct Axis {
  std::string path;  // A field of the scene or a derived angle: core/sweep/field.h lists them.
  std::variant<std::monostate, ListValues, Linspace, Logspace> values;
  friend bool operator==(const Axis&, const Axis&) = default;
};

// The numbers are those of ricochet.v1.SweepRequest.Combination.
enum class Combination {
  kUnspecified = 0,  // Means kProduct.
  kProduct = 1,
  kZip = 2,
};

struct Grid {
  Scene scene;
  std::vector<Axis> axes;  // None: the base scene alone, one point.
  Combination combination = Combination::kUnspecified;
  friend bool operator==(const Grid&, const Grid&) = default;
};

// Every rule that the axes break (not the scene: core/sweep/sweep_run.h). Paths: "axes[0].linspace.count".
std::vector<Violation> ValidateAxes(const Grid& grid);

// Below here the axes are valid.

// Number of values of one axis.
int64_t AxisCount(const Axis& axis);

// Number of points of the grid.
int64_t PointCount(const Grid& grid);

// Value `i` of an axis, 0 <= i < AxisCount(axis). The same bits whichever points are asked for.
double AxisValue(const Axis& axis, int64_t i);

// The position on each axis of point `index`. `positions` has one entry an axis.
void AxisPositions(const Grid& grid, int64_t index, absl::Span<int64_t> positions);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_GRID_H_
