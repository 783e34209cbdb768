// TallyChecker: checks that the counts of a call grow with its points.

#ifndef RICOCHET_CLIENT_TALLY_CHECKER_H_
#define RICOCHET_CLIENT_TALLY_CHECKER_H_

#include "absl/status/status.h"
#include "ricochet/sweep.h"

namespace ricochet {

// Takes the chunks of one call in order. The number of points of each chunk must already be right.
class TallyChecker {
 public:
  // Errors: DATA_LOSS if the tallies do not count each point of `chunk` once and under its regime, or if the summary
  // differs from them.
  absl::Status Check(const SweepChunk& chunk);

  // Returns the counts of the chunks that passed.
  const SweepSummary& counted() const { return counted_; }

 private:
  SweepSummary counted_;
};

}  // namespace ricochet

#endif  // RICOCHET_CLIENT_TALLY_CHECKER_H_
