// CpuQuota: how many cores the control group of a process lets it use, as a container's limit of CPU states them.

#ifndef RICOCHET_SERVER_BASE_CPU_QUOTA_H_
#define RICOCHET_SERVER_BASE_CPU_QUOTA_H_

#include <optional>
#include <string>

namespace ricochet {

// Returns the smallest quota of the process's group and of the groups above it, in cores, > 0; nothing if none has a
// quota, or if the groups are not of version 2. `groups` is the file /proc/self/cgroup, `root` the directory
// /sys/fs/cgroup.
std::optional<double> CpuQuota(const std::string& groups, const std::string& root);

// Returns so many cores, or the quota of this process, rounded up, if that is less. >= 1.
int CoresWithinQuota(int cores);

}  // namespace ricochet

#endif  // RICOCHET_SERVER_BASE_CPU_QUOTA_H_
