// HardCaseResult: one row of the tables of inputs on which textbook formulas fail, with the error of those formulas and
// of the model. There is one table a model.
//
// The tables stand in docs/accuracy.md between "<!-- hard cases: NAME -->" and "<!-- end -->", as printed here.

#ifndef RICOCHET_TESTS_HARD_CASES_HARD_CASE_TABLE_H_
#define RICOCHET_TESTS_HARD_CASES_HARD_CASE_TABLE_H_

#include <string>
#include <vector>

namespace ricochet {

// Stands for an error where naive formulas find another regime.
inline constexpr double kOtherRegime = -1.0;

struct HardCaseResult {
  std::string name;
  std::string why;
  double naive = 0.0;  // Errors in the table's unit; NaN where a formula gives that, or kOtherRegime.
  double promised = 0.0;
  double seen = 0.0;
};

// Demands that every case keeps its promise, and that docs/accuracy.md shows the table. If the environment has
// RICOCHET_UPDATE_GOLDEN=1, the table is written into that page instead.
void CheckTable(const std::string& model, const std::string& unit, const std::vector<HardCaseResult>& results);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_HARD_CASES_HARD_CASE_TABLE_H_
