#include "server/base/cpu_quota.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace ricochet {
namespace {

// The quota in a file cpu.max, "150000 100000" for 1.5 cores; nothing for "max 100000" and for no file.
std::optional<double> QuotaIn(const std::filesystem::path& file) {
  std::ifstream stream(file);
  double time = 0.0;
  double period = 0.0;
  if (!(stream >> time >> period) || !(time > 0.0 && period > 0.0)) return std::nullopt;
  return time / period;
}

// The process's group of version 2, from the line "0::/path".
std::optional<std::filesystem::path> GroupIn(const std::string& groups) {
  constexpr char kVersion2[] = "0::/";
  std::ifstream stream(groups);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(kVersion2)) return line.substr(sizeof(kVersion2) - 1);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> CpuQuota(const std::string& groups, const std::string& root) {
  std::optional<std::filesystem::path> group = GroupIn(groups);
  std::optional<double> smallest;
  while (group.has_value()) {
    const std::optional<double> quota = QuotaIn(root / *group / "cpu.max");
    if (quota.has_value()) smallest = std::min(*quota, smallest.value_or(*quota));
    if (group->empty()) break;
    group = group->parent_path();
  }
  return smallest;
}

int CoresWithinQuota(int cores) {
  const double quota = CpuQuota("/proc/self/cgroup", "/sys/fs/cgroup").value_or(cores);
  return static_cast<int>(std::ceil(std::min<double>(cores, quota)));
}

}  // namespace ricochet
