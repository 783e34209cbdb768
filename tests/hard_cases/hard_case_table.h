// HardCase: inputs on which formulas typed as they stand fail, and what the model makes of them; a table a model.
//
// Tables stand in core/README.md between "<!-- hard cases: NAME -->" and "<!-- end -->", as printed here.

#ifndef RICOCHET_TESTS_HARD_CASES_HARD_CASE_TABLE_H_
#define RICOCHET_TESTS_HARD_CASES_HARD_CASE_TABLE_H_

#include <string>
#include <vector>

namespace ricochet {

// What naive formulas get wrong altogether.
inline constexpr double kOtherRegime = -1.0;

struct HardCaseResult {
  std::string name;
  std::string why;
  double naive = 0.0;  // Errors in the table's unit; NaN where a formula gives that, or kOtherRegime.
  double promised = 0.0;
  double seen = 0.0;
};

// Demands what is promised of every case, and that core/README.md shows the table; RICOCHET_UPDATE_GOLDEN=1 puts it
// there instead.
void CheckTable(const std::string& model, const std::string& unit, const std::vector<HardCaseResult>& results);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_HARD_CASES_HARD_CASE_TABLE_H_
