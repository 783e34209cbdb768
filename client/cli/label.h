// Names of fields for people: what a path stands for, and its unit.

#ifndef RICOCHET_CLIENT_CLI_LABEL_H_
#define RICOCHET_CLIENT_CLI_LABEL_H_

#include <string>

namespace ricochet::cli {

struct Label {
  std::string symbol;  // Short: "μ".
  std::string name;    // "kinetic friction μ".
  std::string unit;    // "rad/s"; empty for a pure number.
};

// Of a path of a scene or an outcome. A path without a name of its own is spelled with spaces.
Label LabelOf(const std::string& path);

// "name [unit]".
std::string WithUnit(const Label& label);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_LABEL_H_
