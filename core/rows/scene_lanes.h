// SceneLanes: blocks of scenes that differ in their numbers alone, solved in SIMD lanes, as batches and sweeps do.
//
// Most scenes of a batch or a sweep are plain: they go from columns of numbers straight to their plan, and those with
// the same model go through its lanes together. Every other one is left to its scene. Both ways give the same bits.

#ifndef RICOCHET_CORE_ROWS_SCENE_LANES_H_
#define RICOCHET_CORE_ROWS_SCENE_LANES_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "core/models/restitution_law.h"
#include "core/plan/demand.h"
#include "core/scene/numbers.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

class SceneLanes {
 public:
  // Scenes are solved in blocks of at most this many.
  static constexpr size_t kBlock = 256;
  // Two bodies in a plane have the most numbers, beside the three that all lanes add at the end.
  static constexpr size_t kMostNumbers = 2 * kNumbersOf<PlanarBody> + 3;

  // The numbers of a scene: those of its system in the order of core/scene/numbers.h, kinetic friction, static friction
  // and the coefficient of restitution.
  using Numbers = std::array<double, kMostNumbers>;

  // A column for each number.
  struct Columns {
    std::array<const double*, kMostNumbers> of = {};
    std::array<bool, kMostNumbers> varies = {};  // False only for a column that has one value for all scenes.
  };

  // The scenes of a block, in their order. One that is left has the model kUnspecified and no results.
  struct Block {
    std::array<Model, kBlock> models;
    std::array<Regime, kBlock> regimes;
    // The entry of a scene that is left is that of an earlier block, or false.
    std::array<bool, kBlock> inadmissible = {};
    bool is_complete = false;  // No scene is left, and every number is finite.
    // True if the block is complete, and all scenes have the model, the regime and the admissibility of the first.
    // False if that is not known.
    bool is_uniform = false;
  };

  // Lanes for the columns of an answer (core/rows/column.h) of scenes that differ from `scene` in numbers alone.
  // Returns null if not every column, or no such scene, can go this way.
  static std::unique_ptr<SceneLanes> Make(const Scene& scene, absl::Span<const std::string> columns,
                                          const Demand& demand);

  virtual ~SceneLanes() = default;

  // True if each number is a field of the scene, so that a column of the field is a column of the number.
  virtual bool TakesFields() const { return true; }
  virtual Numbers NumbersOf(const Scene& scene) const;
  // The paths of the numbers of a scene.
  static std::vector<std::string> PathsOf(const Scene& scene);

  // Solves the scenes [0, count) of the columns, at most kBlock, as far as they are plain. `places[c]` receives column
  // c of the answer.
  virtual void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block) = 0;
};

// Lanes for systems of one kind. They are null if not every column, or no such scene, can go this way.
std::unique_ptr<SceneLanes> MakePendulumLanes(const Scene& scene, absl::Span<const std::string> columns,
                                              const Demand& demand);
std::unique_ptr<SceneLanes> MakePlanarLanes(const Scene& scene, absl::Span<const std::string> columns,
                                            const Demand& demand);
std::unique_ptr<SceneLanes> MakePlanarBodyLanes(const Scene& scene, absl::Span<const std::string> columns,
                                                const Demand& demand);

// The output of a model with a path, by the paths of its outputs in their order.
template <typename Output>
std::optional<Output> OutputAt(absl::Span<const char* const> paths, absl::string_view path) {
  const auto found = path.empty() ? paths.end() : std::find(paths.begin(), paths.end(), path);
  return found == paths.end() ? std::nullopt : std::optional(static_cast<Output>(found - paths.begin()));
}

// Products of a few numbers neither overflow nor underflow if each number is 0 or has a magnitude between the inverse
// of this limit and the limit.
inline constexpr double kMostInLanes = 0x1p200;

// True if coefficients of friction and restitution keep the rules of a scene; a comparison with NaN is false.
bool KeepCoefficientRules(double mu, double mu_static, RestitutionLaw law, double coefficient);

// True if the numbers [first, first + count) of every column are finite.
bool AreFinite(absl::Span<double* const> columns, size_t first, size_t count);

// True if the scene has a system, coefficients of friction and restitution, and nothing else.
bool IsPlain(const Scene& scene);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ROWS_SCENE_LANES_H_
