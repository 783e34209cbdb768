#include "tests/support/paths.h"

namespace ricochet {

std::string SourceRoot() { return RICOCHET_SOURCE_ROOT; }

std::string TestDataPath(const std::string& name) { return SourceRoot() + "/tests/data/" + name; }

}  // namespace ricochet
