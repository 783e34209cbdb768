// SolveInLanes: problems of any laws through the SolveColumns of the pendulum or the planar model, law by law, with the
// results in their order.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_SOLVED_IN_LANES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_SOLVED_IN_LANES_H_

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "absl/types/span.h"
#include "core/models/pendulum/columns.h"
#include "core/models/pendulum/pendulum.h"
#include "core/models/planar/columns.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"

namespace ricochet {

struct SolvedInLanes {
  std::vector<std::vector<double>> columns;  // One for each output, with one entry for each problem.
  std::vector<Regime> regimes;
  std::vector<bool> inadmissible;
  size_t compensated = 0;  // The number of planar problems that needed compensated arithmetic.
};

// `solve(law, problems, solved)` solves problems of one law, and returns how many of them plain arithmetic did not
// serve.
template <typename SolvedColumns, typename Problem, typename Output, typename SolveLaw>
SolvedInLanes SolveLawByLaw(const std::vector<Problem>& problems, const std::vector<Output>& outputs, SolveLaw solve) {
  SolvedInLanes all = {.columns = std::vector(outputs.size(), std::vector<double>(problems.size())),
                       .regimes = std::vector<Regime>(problems.size()),
                       .inadmissible = std::vector<bool>(problems.size())};
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    std::vector<Problem> of_law;
    std::vector<size_t> indices;
    for (size_t i = 0; i < problems.size(); ++i) {
      if (problems[i].law != law) continue;
      of_law.push_back(problems[i]);
      indices.push_back(i);
    }
    const size_t size = indices.size();
    std::vector<std::vector<double>> values(outputs.size(), std::vector<double>(size));
    std::vector<double*> columns;
    for (std::vector<double>& column : values) columns.push_back(column.data());
    std::vector<Regime> regimes(size);
    const auto inadmissible = std::make_unique<bool[]>(size);
    all.compensated += solve(law, of_law,
                             SolvedColumns{.outputs = outputs,
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

namespace pendulum {

inline SolvedInLanes SolveInLanes(const std::vector<Problem>& problems, const std::vector<Output>& outputs,
                                  double tolerance) {
  return SolveLawByLaw<SolvedColumns>(
      problems, outputs, [&](RestitutionLaw law, const std::vector<Problem>& of_law, const SolvedColumns& solved) {
        ProblemColumns columns(law, of_law.size());
        for (size_t k = 0; k < of_law.size(); ++k) columns.Set(k, of_law[k]);
        SolveColumns(columns, 0, of_law.size(), tolerance, solved);
        return size_t{0};
      });
}

}  // namespace pendulum

namespace planar {

// The numbers of problems of one law.
struct PlanarColumnsOfLaw {
  RestitutionLaw law;
  std::array<std::vector<double>, 8> numbers;

  void Add(const Problem& p) {
    const std::array all = {p.w.tt, p.w.tn, p.w.nn, p.u0, p.v0, p.mu, p.mu_static, p.coefficient};
    for (size_t k = 0; k < all.size(); ++k) numbers[k].push_back(all[k]);
  }
  ProblemColumns Columns(size_t first, size_t count) const {
    const auto part = [&](size_t k) { return absl::MakeConstSpan(numbers[k]).subspan(first, count); };
    return {.law = law,
            .wtt = part(0),
            .wtn = part(1),
            .wnn = part(2),
            .u0 = part(3),
            .v0 = part(4),
            .mu = part(5),
            .mu_static = part(6),
            .coefficient = part(7)};
  }
  ProblemColumns Columns() const { return Columns(0, numbers[0].size()); }
};

inline SolvedInLanes SolveInLanes(const std::vector<Problem>& problems, const std::vector<Output>& outputs,
                                  double tolerance) {
  return SolveLawByLaw<SolvedColumns>(
      problems, outputs, [&](RestitutionLaw law, const std::vector<Problem>& of_law, const SolvedColumns& solved) {
        PlanarColumnsOfLaw columns = {.law = law};
        for (const Problem& problem : of_law) columns.Add(problem);
        return SolveColumns(columns.Columns(), tolerance, solved);
      });
}

}  // namespace planar

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_SOLVED_IN_LANES_H_
