// The paths that requests name, for the mutator of messages (tests/fuzz/mutate_message.h): those of the fields and of
// the columns of each system.

#ifndef RICOCHET_TESTS_FUZZ_PATH_TEXTS_H_
#define RICOCHET_TESTS_FUZZ_PATH_TEXTS_H_

#include <string>
#include <vector>

#include "core/rows/column.h"
#include "core/scene/field.h"
#include "ricochet/scene.h"
#include "tests/support/scenes/system_scenes.h"

namespace ricochet {

// Calls append(scene) for a scene of each system.
template <typename Append>
void ForEachSystem(const Append& append) {
  append(With(Pendulum()));
  for (const System& system : Systems()) append(With(system));
}

inline std::vector<std::string> FieldTexts() {
  std::vector<std::string> texts;
  ForEachSystem([&texts](const Scene& scene) {
    for (std::string& path : FieldPaths(scene)) texts.push_back(std::move(path));
  });
  return texts;
}

inline std::vector<std::string> ColumnTexts() {
  std::vector<std::string> texts;
  ForEachSystem([&texts](const Scene& scene) {
    for (std::string& path : Columns(scene)) texts.push_back(std::move(path));
  });
  return texts;
}

}  // namespace ricochet

#endif  // RICOCHET_TESTS_FUZZ_PATH_TEXTS_H_
