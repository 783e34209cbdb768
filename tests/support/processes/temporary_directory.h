// A directory that exists as long as an object does.

#ifndef RICOCHET_TESTS_SUPPORT_PROCESSES_TEMPORARY_DIRECTORY_H_
#define RICOCHET_TESTS_SUPPORT_PROCESSES_TEMPORARY_DIRECTORY_H_

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace ricochet {

class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string pattern = std::filesystem::temp_directory_path() / "ricochet_test.XXXXXX";
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no directory can be made: " + pattern);
    path_ = pattern;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Returns the path of a file in the directory.
  std::string operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_SUPPORT_PROCESSES_TEMPORARY_DIRECTORY_H_
