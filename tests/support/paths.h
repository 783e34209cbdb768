// Paths of test data in the source tree.

#ifndef RICOCHET_TESTS_SUPPORT_PATHS_H_
#define RICOCHET_TESTS_SUPPORT_PATHS_H_

#include <string>

namespace ricochet {

// The top folder of the source tree.
std::string SourceRoot();

// A file or folder of tests/data.
std::string TestDataPath(const std::string& name);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PATHS_H_
