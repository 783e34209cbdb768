// The picture of one impact.

#ifndef RICOCHET_CLIENT_CLI_REPORT_SOLVE_PLOT_H_
#define RICOCHET_CLIENT_CLI_REPORT_SOLVE_PLOT_H_

#include "absl/status/statusor.h"
#include "client/cli/plot/plot.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Returns panels over the normal impulse tau: angular velocities, or without joints the velocities of the contact; the
// friction force over the normal force; the friction impulse. These are figs. 3 and 5 of Lubarda (2009). An impact that
// takes time has its forces, indentation and velocities over time, and the loop of its normal force over the
// indentation. An impact in space has the slip hodograph, the velocities of the contact and the friction impulse.
//
// `response` is the answer to `request`. What a picture needs beyond it is asked of `solver`, with the same numbers:
// the forces at kPlotIntervals steps unless the request asks for others, and the path of an impact in space at as many.
// Errors: FAILED_PRECONDITION if the contact separates; those of the solver.
absl::StatusOr<Plot> SolvePlot(const Solver& solver, const SolveRequest& request, const SolveResponse& response);

inline constexpr int kPlotIntervals = 400;

// Returns velocities after an impact in space, so many and one, from that before the impact to that after it. W is
// constant, so that an audit of each gives the state of Coulomb's path at that part of the normal impulse. The outcome
// must have a timeline.
AuditColumns PartsOfTheWay(const Outcome& outcome, int intervals);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_SOLVE_PLOT_H_
