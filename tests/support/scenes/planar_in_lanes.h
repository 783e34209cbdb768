// PlanarInLanes: problems of any laws through planar::SolveColumns, law by law, with the results in their order.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_PLANAR_IN_LANES_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_PLANAR_IN_LANES_H_

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "absl/types/span.h"
#include "core/models/planar/columns.h"
#include "core/models/planar/planar.h"
#include "core/models/restitution_law.h"

namespace ricochet::planar {

struct PlanarInLanes {
  std::vector<std::vector<double>> columns;  // One for each output, with one entry for each problem.
  std::vector<Regime> regimes;
  std::vector<bool> inadmissible;
  size_t compensated = 0;
};

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

inline PlanarInLanes SolveInLanes(const std::vector<Problem>& problems, const std::vector<Output>& outputs,
                                  double tolerance) {
  PlanarInLanes all = {.columns = std::vector(outputs.size(), std::vector<double>(problems.size())),
                       .regimes = std::vector<Regime>(problems.size()),
                       .inadmissible = std::vector<bool>(problems.size())};
  for (const RestitutionLaw law : {RestitutionLaw::kNewton, RestitutionLaw::kPoisson, RestitutionLaw::kEnergetic}) {
    PlanarColumnsOfLaw of_law = {.law = law};
    std::vector<size_t> indices;
    for (size_t i = 0; i < problems.size(); ++i) {
      if (problems[i].law != law) continue;
      of_law.Add(problems[i]);
      indices.push_back(i);
    }
    const size_t size = indices.size();
    std::vector<std::vector<double>> values(outputs.size(), std::vector<double>(size));
    std::vector<double*> columns;
    for (std::vector<double>& column : values) columns.push_back(column.data());
    std::vector<Regime> regimes(size);
    const auto inadmissible = std::make_unique<bool[]>(size);
    all.compensated += SolveColumns(of_law.Columns(), tolerance,
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

}  // namespace ricochet::planar

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_PLANAR_IN_LANES_H_
