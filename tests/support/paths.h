// Where the tests find their data.

#ifndef RICOCHET_TESTS_SUPPORT_PATHS_H_
#define RICOCHET_TESTS_SUPPORT_PATHS_H_

#include <string>

namespace ricochet {

// The absolute path of the file `name` in tests/data.
inline std::string TestDataPath(const std::string& name) { return std::string(RICOCHET_TEST_DATA_DIR) + "/" + name; }

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PATHS_H_
