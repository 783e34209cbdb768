// Texts of a cost study: what each method takes, claims and errs by, as a table and as CSV.

#ifndef RICOCHET_CLIENT_CLI_REPORT_COST_REPORT_H_
#define RICOCHET_CLIENT_CLI_REPORT_COST_REPORT_H_

#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/cost.h"

namespace ricochet::cli {

// The functions below take a whole study: all rows in one CostChunk, with its summary.

// Returns tables of at most 100 columns: the methods, the plan's picks, notes, how far the claims can be trusted, and
// the machine.
std::string CostText(const CostChunk& study);

// Returns one line for each method, at full precision. The columns are named as the fields of ricochet.v1.CostRow.
std::string CostCsv(const CostChunk& study);

// --- Parts that the pictures and the page share ---

// Returns three digits and a unit: "12.3 ns", "1.20 ms", "160 µs".
std::string TimeText(double seconds);

// Returns half the distance of the quartiles over the median: "3 %".
std::string SpreadText(const CostTime& time);

// Returns two digits: "1.2e-16", "0", "unknown" for infinity.
std::string ErrorText(double error);

// Returns a part of the error made, or the bound that the error of the reference leaves: "<=3.9e-13". It is empty if
// the error is not known.
std::string MadeText(const CostRow& row, double CostError::*part);

// Returns the tolerances of a pick: "1e-12 to 0.001".
std::string PickRangeText(const CostPick& pick);

// Returns the name of the method that the plan picks, with the error that it claims.
std::string PickName(const CostChunk& study, const CostPick& pick);

// Returns how many answers err by more than they claim, how many methods gave none, and how many had no time left.
std::string TrustText(const CostChunk& study);

// Returns how many methods gave an answer whose error is known.
int64_t AnswerCount(const CostChunk& study);

// A sentence that is said of one method or more.
struct CostNote {
  std::string text;
  std::vector<std::string> methods;
};
std::vector<CostNote> NotesOf(const CostChunk& study);

// Returns the processor, its SIMD instructions and the compiler, with a warning if the build does not optimize.
std::string MachineText(const CostMachine& machine);

// Returns for each row whether it lies on the Pareto front.
std::vector<bool> OnFront(const CostChunk& study);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_REPORT_COST_REPORT_H_
