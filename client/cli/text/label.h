// Labels: the symbol, the name and the unit of a field, for plots.

#ifndef RICOCHET_CLIENT_CLI_TEXT_LABEL_H_
#define RICOCHET_CLIENT_CLI_TEXT_LABEL_H_

#include <string>

namespace ricochet::cli {

struct Label {
  std::string symbol;  // A short name: "μ".
  std::string name;    // "kinetic friction μ".
  std::string unit;    // "rad/s"; empty for a pure number.
};

// Returns the label of a path of a scene or an outcome, with the unit of the field table. A path without a name of its
// own is its own name.
Label LabelOf(const std::string& path);

// Returns "name [unit]".
std::string WithUnit(const Label& label);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_TEXT_LABEL_H_
