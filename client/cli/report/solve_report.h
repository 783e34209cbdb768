// The report of an outcome as text and CSV.

#ifndef RICOCHET_CLIENT_CLI_REPORT_SOLVE_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_SOLVE_REPORT_H_

#include <string>

#include "ricochet/outcome.h"

namespace ricochet::cli {

// Returns what the contact does, in a sentence or two.
std::string WhatHappens(const Outcome& outcome);

// Says in a sentence why the outcome is not an answer; empty if it is one.
const char* TerminationText(Termination termination);

// Returns what happens in an event: "slip stops".
const char* EventText(EventKind kind);

// Returns tables with units, to six digits. If the surface moves, works are those on velocities relative to it.
std::string SolveText(const Outcome& outcome, bool surface_moves);

// Returns a header and one row: every number of the outcome, named by its path, without the lists of events, states and
// broken limits and without the certificate.
std::string SolveCsv(const Outcome& outcome);

// Returns a header and one row for each state of the history.
std::string HistoryCsv(const Outcome& outcome);

// Returns a header and one row for each sample of the forces.
std::string ForceHistoryCsv(const Outcome& outcome);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_SOLVE_REPORT_H_
