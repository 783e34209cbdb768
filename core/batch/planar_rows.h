// PlanarRows: the rows of a batch of planar contacts, in SIMD lanes and without a scene for each.
//
// Most contacts of a simulation are plain: rigid, with a W of full rank, friction and a coefficient of restitution, and
// a tolerance for all. Such a row goes from the input columns straight to its plan and its model. Every other row is left
// to the scene. Both ways give the same bits.

#ifndef RICOCHET_CORE_BATCH_PLANAR_ROWS_H_
#define RICOCHET_CORE_BATCH_PLANAR_ROWS_H_

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "core/models/planar/columns.h"
#include "core/plan/choose.h"
#include "core/plan/demand.h"
#include "ricochet/batch.h"
#include "ricochet/plan.h"

namespace ricochet {

class PlanarRows {
 public:
  // Rows are solved in blocks of at most this many.
  static constexpr size_t kBlock = 256;

  // What a row of a block has come to.
  struct Verdict {
    bool is_solved = false;  // False if the row is left to the scene.
    bool inadmissible = false;
    Regime regime = Regime::kInvalid;
    Model model = Model::kUnspecified;
  };

  // `scene` is the base scene in which the setup's fields are resolved. Returns nothing if its rows cannot go this way.
  static std::optional<PlanarRows> Make(const Scene& scene, const BatchSetup& setup, const Demand& demand);

  // Solves the rows [first, first + count), of at most kBlock, as far as they are plain.
  void Solve(const BatchRows& rows, size_t first, size_t count, absl::Span<Verdict> verdicts);

 private:
  // The numbers of a contact, in this order.
  enum Number { kWtt, kWtn, kWnn, kU0, kV0, kMu, kMuStatic, kCoefficient, kNumberCount };
  using Block = std::array<double, kBlock>;

  explicit PlanarRows(const Demand& demand) : demand_(demand) {}
  void Load(const BatchRows& rows, size_t first, size_t count);
  planar::Problem ProblemAt(size_t i) const;
  void Plan(size_t i, Verdict& verdict);
  void SolveStraight(size_t i, const planar::Problem& problem, Verdict& verdict);

  Demand demand_;
  RestitutionLaw law_ = RestitutionLaw::kEnergetic;
  std::array<double, kNumberCount> base_ = {};
  std::array<std::optional<size_t>, kNumberCount> column_of_ = {};  // The input column that states the number.
  bool static_is_kinetic_ = false;                                  // The scene states no static coefficient.
  std::vector<planar::Output> outputs_;                             // One for each output column.

  std::array<Block, kNumberCount> numbers_;                        // Of the current block.
  std::vector<double*> places_;                                    // Of the outputs of the current block.
  std::vector<size_t> straight_;                                   // Rows of the block that a straight model solves.
  std::vector<std::array<double, planar::kOutputCount>> answers_;  // Their answers.
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_BATCH_PLANAR_ROWS_H_
