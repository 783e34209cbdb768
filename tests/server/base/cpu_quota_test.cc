// CpuQuota reads the limit of CPU of a container from the files of the control groups.

#include "server/base/cpu_quota.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace ricochet {
namespace {

class CpuQuotaTest : public testing::Test {
 protected:
  CpuQuotaTest() : root_(std::filesystem::path(testing::TempDir()) / "ricochet_cpu_quota") {
    std::filesystem::remove_all(root_);
  }
  ~CpuQuotaTest() override { std::filesystem::remove_all(root_); }

  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  std::optional<double> Quota() const { return CpuQuota(root_ / "cgroup", root_ / "fs"); }

 private:
  const std::filesystem::path root_;
};

TEST_F(CpuQuotaTest, AContainerSeesItsOwnGroupAsTheRoot) {
  Write("cgroup", "0::/\n");
  Write("fs/cpu.max", "150000 100000\n");
  EXPECT_EQ(Quota(), 1.5);
}

TEST_F(CpuQuotaTest, TheSmallestQuotaOfAllGroupsAboveCounts) {
  Write("cgroup", "1:name=systemd:/\n0::/pods/pod/container\n");
  Write("fs/pods/pod/container/cpu.max", "400000 100000\n");
  Write("fs/pods/pod/cpu.max", "100000 50000\n");
  Write("fs/pods/cpu.max", "max 100000\n");
  EXPECT_EQ(Quota(), 2.0);
}

TEST_F(CpuQuotaTest, NoQuotaIsNone) {
  EXPECT_EQ(Quota(), std::nullopt);
  Write("cgroup", "5:cpu:/old\n0::/\n");
  EXPECT_EQ(Quota(), std::nullopt);
  for (const char* text : {"max 100000\n", "", "0 100000\n", "100000\n", "-1 100000\n", "what\n"}) {
    Write("fs/cpu.max", text);
    EXPECT_EQ(Quota(), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace ricochet
