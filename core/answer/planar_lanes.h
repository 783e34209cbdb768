// PlanarLanes: blocks of planar contacts in SIMD lanes, as batches and sweeps solve them, without a scene for each.
//
// Most contacts are plain: rigid, with a W of full rank, friction and a coefficient of restitution, and a tolerance for
// all. Such contacts go from columns of numbers straight to their plan, and those with the same model go through its lanes
// together. Every other contact is left to its scene. Both ways give the same bits.

#ifndef RICOCHET_CORE_ANSWER_PLANAR_LANES_H_
#define RICOCHET_CORE_ANSWER_PLANAR_LANES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "core/models/planar_outputs.h"
#include "core/plan/demand.h"
#include "ricochet/outcome.h"
#include "ricochet/plan.h"
#include "ricochet/scene.h"

namespace ricochet {

class PlanarLanes {
 public:
  // Contacts are solved in blocks of at most this many.
  static constexpr size_t kBlock = 256;

  // The numbers of a contact, in this order.
  enum Number { kWtt, kWtn, kWnn, kU0, kV0, kMu, kMuStatic, kCoefficient, kNumberCount };
  using Numbers = std::array<double, kNumberCount>;

  // A column for each number.
  struct Columns {
    std::array<const double*, kNumberCount> of = {};
    std::array<bool, kNumberCount> varies = {};  // False only for a column that has one value for all contacts.
  };

  // The contacts of a block, in their order. One that is left to its scene has the model kUnspecified and no results.
  struct Block {
    std::array<Model, kBlock> models;
    std::array<Regime, kBlock> regimes;
    std::array<bool, kBlock> inadmissible;
  };

  // The outputs behind the columns of an answer (core/sweep/column.h), or nothing if not every one of them, or no contact
  // of such a scene, can go this way. The numbers of the scene do not matter.
  static std::optional<std::vector<PlanarOutput>> OutputsOf(const Scene& scene, absl::Span<const std::string> columns,
                                                            const Demand& demand);

  // The numbers of a scene for which OutputsOf gives outputs.
  static Numbers NumbersOf(const Scene& scene);

  // `outputs` are those of OutputsOf; the law of restitution is that of the scene.
  PlanarLanes(const Scene& scene, std::vector<PlanarOutput> outputs, double tolerance);

  // Solves the contacts [0, count) of the columns, at most kBlock, as far as they are plain. `places[c]` receives output c.
  void Solve(const Columns& columns, size_t count, absl::Span<double* const> places, Block& block);

  // True if no contact of the block solved last was left to its scene, and every number of it is finite.
  bool HasAllNumbers(size_t count, absl::Span<double* const> places, const Block& block) const;

 private:
  using Column = std::array<double, kBlock>;

  PlanarProblemColumns ProblemsIn(const Columns& columns, size_t count) const;
  void SolveBy(Model model, const Columns& columns, size_t count, const PlanarSolvedColumns& solved) const;
  Columns Gather(const Columns& columns, absl::Span<const uint16_t> some);
  void SolveTogether(const Columns& columns, absl::Span<const uint16_t> some, size_t count, Model model,
                     absl::Span<double* const> places, Block& block);
  void Separate(const Columns& columns, size_t i, absl::Span<double* const> places, Block& block) const;
  Model ModelAlone(const PlanarProblem& problem) const;

  RestitutionLaw law_;
  double tolerance_;
  std::vector<PlanarOutput> outputs_;

  // Contacts of the block that one model solves: their numbers and outputs.
  std::array<Column, kNumberCount> gathered_;
  std::vector<Column> answers_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ANSWER_PLANAR_LANES_H_
