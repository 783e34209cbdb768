// The chains of links of tests/data/linkage.csv.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_LINKAGE_ROWS_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_LINKAGE_ROWS_H_

#include <string>
#include <vector>

#include "ricochet/scene.h"
#include "tests/support/scenes/laws_by_name.h"
#include "tests/support/scenes/vectors.h"

namespace ricochet {

// The numbers of a cell that holds several.
inline std::vector<double> NumbersIn(const std::string& cell) {
  std::vector<double> numbers;
  for (const std::string& number : SplitCells(cell, ';')) numbers.push_back(std::stod(number));
  return numbers;
}

inline Scene ChainOf(const VectorRow& row) {
  const std::vector<double> shapes = NumbersIn(row.at("links_length_mass_com_inertia"));
  const std::vector<double> thetas = NumbersIn(row.at("theta"));
  const std::vector<double> rates = NumbersIn(row.at("rate"));
  Linkage linkage;
  for (size_t i = 0; i < thetas.size(); ++i) {
    const double* shape = shapes.data() + 4 * i;
    linkage.links.push_back({shape[0], shape[1], shape[2], shape[3], thetas[i], rates[i]});
  }
  return {.system = linkage,
          .friction = {.kinetic_coefficient = Number(row, "mu")},
          .restitution = RestitutionOf(row.at("law"), Number(row, "coefficient"))};
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_LINKAGE_ROWS_H_
