// Compares the order in which a plan tries the models of a contact (core/plan/candidates.h) with the times that `cost`
// measures, and prints each pair. Fails where a model takes over twice the time of one that comes later.

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "absl/types/span.h"
#include "core/cost/cost.h"
#include "core/plan/candidates.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet::bench {
namespace {

// Times of models nearer to each other than this depend on the scene.
constexpr double kFarApart = 2.0;

std::vector<CostRow> RowsOf(const Scene& scene) {
  auto study = CostStudy::Make({.scene = scene, .time_limit_s = 10.0});
  std::vector<CostRow> rows;
  while (study.ok() && !study->ended()) {
    const auto chunk = study->NextChunk([] { return false; });
    if (!chunk.ok()) std::exit(1);
    rows.insert(rows.end(), chunk->rows.begin(), chunk->rows.end());
  }
  return rows;
}

// The row of plain arithmetic in which a model takes the least time; null if it has none.
const CostRow* FastestOf(Model model, const std::vector<CostRow>& rows) {
  const CostRow* fastest = nullptr;
  for (const CostRow& row : rows) {
    if (row.method.model != model || row.method.arithmetic != Arithmetic::kPlain || !row.solve.has_value()) continue;
    if (fastest == nullptr || row.solve->median_s < fastest->solve->median_s) fastest = &row;
  }
  return fastest;
}

// Returns how many pairs stand in the wrong order.
int WrongPairs(absl::Span<const Candidate> candidates, const Scene& scene) {
  const std::vector<CostRow> rows = RowsOf(scene);
  int wrong = 0;
  for (size_t later = 1; later < candidates.size(); ++later) {
    for (size_t first = 0; first < later; ++first) {
      const CostRow* const one = FastestOf(candidates[first].model, rows);
      const CostRow* const other = FastestOf(candidates[later].model, rows);
      if (one == nullptr || other == nullptr) continue;
      const double ratio = one->solve->median_s / other->solve->median_s;
      const bool is_wrong = ratio > kFarApart;
      std::printf("%-24s takes %9.3g times as long as %s%s\n", one->name.c_str(), ratio, other->name.c_str(),
                  is_wrong ? ": it should come later" : "");
      if (is_wrong) ++wrong;
    }
  }
  return wrong;
}

Scene Compliant(Scene scene) {
  scene.compliance = {.tangential_ratio_squared = 1.5, .normal = LinearSpring{1e6}};
  return scene;
}

int Main() {
  Scene slides = With(PlanarContact{1.2, 0.3, 1.0, 3.0, -1.0});
  slides.friction.kinetic_coefficient = 0.1;
  Scene pendulum = With(Pendulum{1.0, 1.0, 0.3, -1.0});
  pendulum.friction.kinetic_coefficient = 0.2;
  const int wrong = WrongPairs(kPlanarCandidates, Compliant(slides)) +
                    WrongPairs(kPendulumCandidates, Compliant(pendulum)) +
                    WrongPairs(kSpatialCandidates, With(ContactInSpace()));
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace ricochet::bench

int main() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  return ricochet::bench::Main();
}
