// Grid: a base scene and the axes that drive it.
//
// A kProduct grid has a point for every combination of the axes' values, and the last axis runs fastest. The axes of a
// kZip grid are equally long and advance together. Nothing is stored per point, so a grid of 10^9 points needs no more
// memory than one of 10.

#ifndef RICOCHET_GRID_H_
#define RICOCHET_GRID_H_

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/scene.h"

namespace ricochet {

struct ListValues {
  std::vector<double> values = {};  // At least one.
  friend bool operator==(const ListValues&, const ListValues&) = default;
};

// A Linspace is `count` evenly spaced values from `start` to `stop`; both ends are exact. One value is `start`.
struct Linspace {
  double start = 0.0;
  double stop = 0.0;
  int64_t count = 0;  // >= 1
  friend bool operator==(const Linspace&, const Linspace&) = default;
};

// A Logspace is `count` values from `start` to `stop`, both > 0, evenly spaced in their logarithm; both ends are exact.
struct Logspace {
  double start = 0.0;
  double stop = 0.0;
  int64_t count = 0;  // >= 1
  friend bool operator==(const Logspace&, const Logspace&) = default;
};

struct Axis {
  std::string path = {};  // A field of the scene or a derived angle, as `ricochet scene fields` lists them.
  std::variant<std::monostate, ListValues, Linspace, Logspace> values = {};
  friend bool operator==(const Axis&, const Axis&) = default;
};

// The numbers are those of ricochet.v1.SweepRequest.Combination.
enum class Combination {
  kUnspecified = 0,  // Means kProduct.
  kProduct = 1,
  kZip = 2,
};

struct Grid {
  Scene scene = {};
  std::vector<Axis> axes = {};  // A grid without axes has one point, the base scene.
  Combination combination = Combination::kUnspecified;
  friend bool operator==(const Grid&, const Grid&) = default;
};

}  // namespace ricochet

#endif  // RICOCHET_GRID_H_
