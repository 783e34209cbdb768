// The numbers of a scene that a column of a batch or an axis of a sweep may drive alone.

#ifndef RICOCHET_TESTS_SUPPORT_SCENES_DRIVABLE_NUMBERS_H_
#define RICOCHET_TESTS_SUPPORT_SCENES_DRIVABLE_NUMBERS_H_

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/field.h"
#include "core/scene/numbers.h"
#include "ricochet/scene.h"

namespace ricochet {

// Calls visit(path, number) for each of them, in the order of VisitNumbers. The lower triangle of a mass matrix, which
// goes along with the upper one, is none.
template <typename Visit>
void VisitDrivableNumbers(const Scene& scene, const Visit& visit) {
  const std::vector<std::string> drivable = FieldPaths(scene);
  VisitNumbers(scene, [&](const NumberPath& path, double number, NumberRule /*rule*/) {
    std::string text = path.Text();
    if (std::find(drivable.begin(), drivable.end(), text) != drivable.end()) visit(std::move(text), number);
  });
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_SCENES_DRIVABLE_NUMBERS_H_
