// InvalidPoints: why points of a sweep have no numbers. The answer of a sweep only flags them, so that it stays small;
// the command line finds the reason by checking the scene of the point again.

#ifndef RICOCHET_CLIENT_CLI_REPORT_INVALID_POINTS_H_
#define RICOCHET_CLIENT_CLI_REPORT_INVALID_POINTS_H_

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "core/plan/demand.h"
#include "core/rows/driven_scene.h"
#include "ricochet/error.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

class InvalidPoints {
 public:
  explicit InvalidPoints(const SweepRequest& request);

  // True if the scene of a point keeps every rule and needs no effect that the request excludes: if the point has no
  // numbers, one of them is too large.
  bool KeepsRules(int64_t index);

  // Returns the first reason of an invalid point of a grid that a solver has taken:
  // "friction.kinetic_coefficient = -0.1: must be >= 0".
  std::string Reason(int64_t index);

  // Returns the reason without the value, so that points can be counted by it:
  // "friction.kinetic_coefficient: must be >= 0".
  std::string Rule(int64_t index);

 private:
  // The first rule that a point breaks, if it breaks one.
  std::optional<Violation> First(int64_t index);
  Violation WhyInvalid(int64_t index);

  Grid grid_;
  Demand demand_;
  std::shared_ptr<DrivenScene> driven_;  // Made for the first invalid point.
};

// Counts the points of a sweep whose numbers are no answer, or not a sound one: the invalid ones by their reason, the
// inadmissible ones, and those that did not converge.
class DoubtfulPoints {
 public:
  explicit DoubtfulPoints(const SweepRequest& request);

  void Add(const SweepChunk& chunk);

  // Returns a line for each kind of points and for each reason, with the number of points and the first of them; empty
  // if there are none. The number of all includes those of an earlier run that was gone on with, whose reasons are not
  // known.
  std::string Text() const;

  // Errors: FAILED_PRECONDITION if a point is invalid, inadmissible or has no end.
  absl::Status CheckStrictly() const;

 private:
  // Finding a reason takes microseconds, so only this many invalid points are examined, and they stand for all.
  static constexpr int64_t kMostReasons = 100'000;

  bool IsInvalid(const SweepChunk& chunk, int64_t i);

  InvalidPoints points_;
  bool may_lack_numbers_;  // A valid point may have NaN in every column.
  int64_t count_ = 0;      // The number of invalid points examined.
  SweepSummary summary_;   // That of the whole sweep.
  std::map<std::string, Tally> by_rule_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_INVALID_POINTS_H_
