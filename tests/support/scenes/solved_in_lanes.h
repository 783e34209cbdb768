// SolvedInLanes: problems of any laws through pendulum::SolveColumns, law by law, with the results in their order.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_SOLVED_IN_LANES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_SOLVED_IN_LANES_H_

#include <cstddef>
#include <memory>
#include <vector>

#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/restitution_law.h"

namespace ricochet::pendulum {

struct SolvedInLanes {
  std::vector<std::vector<double>> columns;  // One for each output, with one entry for each problem.
  std::vector<Regime> regimes;
  std::vector<bool> inadmissible;
};

inline std::vector<size_t> OfLaw(RestitutionLaw law, const std::vector<Problem>& problems) {
  std::vector<size_t> indices;
  for (size_t i = 0; i < problems.size(); ++i) {
    if (problems[i].law == law) indices.push_back(i);
  }
  return indices;
}

inline SolvedInLanes SolveInLanes(const std::vector<Problem>& problems, const std::vector<Output>& outputs,
                                  double tolerance) {
  SolvedInLanes all = {.columns = std::vector(outputs.size(), std::vector<double>(problems.size())),
                       .regimes = std::vector<Regime>(problems.size()),
                       .inadmissible = std::vector<bool>(problems.size())};
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    const std::vector<size_t> indices = OfLaw(law, problems);
    const size_t size = indices.size();
    ProblemColumns of_law(law, size);
    for (size_t k = 0; k < size; ++k) of_law.Set(k, problems[indices[k]]);
    std::vector<std::vector<double>> values(outputs.size(), std::vector<double>(size));
    std::vector<double*> columns;
    for (std::vector<double>& column : values) columns.push_back(column.data());
    std::vector<Regime> regimes(size);
    const auto inadmissible = std::make_unique<bool[]>(size);
    SolveColumns(of_law, 0, size, tolerance,
                 {.outputs = outputs,
                  .columns = columns,
                  .regimes = absl::MakeSpan(regimes),
                  .inadmissible = {inadmissible.get(), size}});
    for (size_t k = 0; k < size; ++k) {
      for (size_t c = 0; c < outputs.size(); ++c) all.columns[c][indices[k]] = values[c][k];
      all.regimes[indices[k]] = regimes[k];
      all.inadmissible[indices[k]] = inadmissible[k];
    }
  }
  return all;
}

}  // namespace ricochet::pendulum

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_SOLVED_IN_LANES_H_
