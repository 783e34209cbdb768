// NumberPath: the path PREFIX[ENTRY].NAME[INDEX] of a number of a scene or an outcome, as the proto spells it:
// "linkage.links[1].theta_rad".
//
// A negative index is left out, and so are an empty prefix and its dot. The path becomes text only when Text() is
// called, because most paths are never printed.

#ifndef RICOCHET_NUMBER_PATH_H_
#define RICOCHET_NUMBER_PATH_H_

#include <string>

namespace ricochet {

struct NumberPath {
  const char* prefix = "";
  int entry = -1;
  const char* name = "";
  int index = -1;

  std::string Text() const {
    const auto indexed = [](const char* word, int i) {
      return i < 0 ? std::string(word) : std::string(word) + "[" + std::to_string(i) + "]";
    };
    return (*prefix == '\0' ? "" : indexed(prefix, entry) + ".") + indexed(name, index);
  }
};

}  // namespace ricochet

#endif  // RICOCHET_NUMBER_PATH_H_
