// PlanarRows: the rows of a batch of planar contacts, in SIMD lanes and without a scene for each.
//
// Most contacts of a simulation are plain: rigid, with a W of full rank, friction and a coefficient of restitution, and
// a tolerance for all. Such rows go from the input columns straight to their plan, and those with the same model go through
// its lanes together. Every other row is left to the scene. Both ways give the same bits.

#ifndef RICOCHET_CORE_BATCH_PLANAR_ROWS_H_
#define RICOCHET_CORE_BATCH_PLANAR_ROWS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "core/models/planar_outputs.h"
#include "core/plan/demand.h"
#include "ricochet/batch.h"
#include "ricochet/plan.h"

namespace ricochet {

class PlanarRows {
 public:
  // Rows are solved in blocks of at most this many.
  static constexpr size_t kBlock = 256;

  // The rows of a block, in their order. A row left to its scene has the model kUnspecified and no results.
  struct Block {
    std::array<Model, kBlock> models;
    std::array<Regime, kBlock> regimes;
    std::array<bool, kBlock> inadmissible;
  };

  // `scene` is the base scene in which the setup's fields are resolved. Returns nothing if its rows cannot go this way.
  static std::optional<PlanarRows> Make(const Scene& scene, const BatchSetup& setup, const Demand& demand);

  // Solves the rows [first, first + count), of at most kBlock, as far as they are plain.
  void Solve(const BatchRows& rows, size_t first, size_t count, Block& block);

  // True if no row of the block solved last was left to its scene, and every number of it is finite.
  bool HasAllNumbers(size_t count, const Block& block) const;

 private:
  // The numbers of a contact, in this order.
  enum Number { kWtt, kWtn, kWnn, kU0, kV0, kMu, kMuStatic, kCoefficient, kNumberCount };
  using Numbers = std::array<double, kBlock>;
  using Columns = std::array<const double*, kNumberCount>;

  explicit PlanarRows(const Demand& demand) : demand_(demand) {}
  Columns ColumnsOf(const BatchRows& rows, size_t first) const;
  PlanarProblemColumns ProblemsIn(const Columns& columns, size_t count) const;
  void SolveBy(Model model, const Columns& columns, size_t count, const PlanarSolvedColumns& solved) const;
  Columns Gather(const Columns& columns, absl::Span<const uint16_t> some);
  void SolveTogether(const Columns& columns, absl::Span<const uint16_t> some, size_t count, Model model, Block& block);
  void Separate(const Columns& columns, size_t i, Block& block) const;
  Model ModelAlone(const PlanarProblem& problem) const;

  Demand demand_;
  RestitutionLaw law_ = RestitutionLaw::kEnergetic;
  std::array<std::optional<size_t>, kNumberCount> column_of_ = {};  // The input column that states the number.
  bool static_is_kinetic_ = false;                                  // The scene states no static coefficient.
  std::vector<PlanarOutput> outputs_;                               // One for each output column.

  std::array<Numbers, kNumberCount> base_;  // The numbers that no column states.
  std::vector<double*> places_;             // Of the outputs of the current block.
  // Rows of the block that one model solves: their numbers and outputs.
  std::array<Numbers, kNumberCount> gathered_;
  std::vector<Numbers> answers_;
  std::vector<double*> answer_places_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BATCH_PLANAR_ROWS_H_
