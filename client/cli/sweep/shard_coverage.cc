#include "client/cli/sweep/shard_coverage.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/base/counted.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

constexpr size_t kMostFaults = 20;

// The range [first, end), which is not empty.
std::string PointsText(int64_t first, int64_t end) {
  return first + 1 == end ? absl::StrCat("point ", first) : absl::StrCat("points ", first, " to ", end - 1);
}

absl::Status CheckManifest(const ShardFile& shard) {
  const Shard& manifest = shard.manifest;
  const v1::SweepRequest& sweep = manifest.sweep();
  const bool is_sound = sweep.has_end_index() && manifest.first_index() >= sweep.first_index() &&
                        manifest.first_index() <= manifest.end_index() && manifest.end_index() <= sweep.end_index() &&
                        manifest.rows() == manifest.end_index() - manifest.first_index() &&
                        manifest.grid_fingerprint() == GridFingerprint(FromProto(sweep));
  if (is_sound) return absl::OkStatus();
  return absl::DataLossError(
      absl::StrCat("the manifest of ", shard.Name(), " contradicts itself: remove it and compute the shard anew"));
}

absl::Status CheckSameSweep(const ShardFile& shard, const ShardFile& other) {
  if (FromProto(shard.manifest.sweep()) != FromProto(other.manifest.sweep())) {
    return absl::InvalidArgumentError(absl::StrCat(
        other.Name(), " is of another sweep than ", shard.Name(), ": its grid has the fingerprint ",
        other.manifest.grid_fingerprint(), ", not ", shard.manifest.grid_fingerprint(), ", or its range differs"));
  }
  const v1::Engine& one = shard.manifest.engine();
  const v1::Engine& two = other.manifest.engine();
  if (one.fingerprint() == two.fingerprint()) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      other.Name(), " comes from the engine ", two.version(), ", ", two.fingerprint(), ", and ", shard.Name(), " from ",
      one.version(), ", ", one.fingerprint(), ": they may differ in their last bits and must not be mixed"));
}

// Returns which points are missing or there twice. `shards` are in order.
std::vector<std::string> FaultsOf(const std::vector<ShardFile>& shards) {
  std::vector<std::string> faults;
  const v1::SweepRequest& sweep = shards.front().manifest.sweep();
  int64_t next = sweep.first_index();
  const ShardFile* last = nullptr;  // The shard that ends at `next`.
  const auto missing = [&faults, &next](int64_t end, const std::string& where) {
    if (next < end) faults.push_back(absl::StrCat("no shard has ", PointsText(next, end), where));
  };
  for (const ShardFile& shard : shards) {
    const Shard& manifest = shard.manifest;
    if (manifest.rows() == 0) continue;
    missing(manifest.first_index(), absl::StrCat(", before ", shard.Name()));
    if (manifest.first_index() < next) {
      faults.push_back(absl::StrCat("both ", last->Name(), " and ", shard.Name(), " have ",
                                    PointsText(manifest.first_index(), std::min(next, manifest.end_index()))));
    }
    if (manifest.end_index() <= next) continue;
    next = manifest.end_index();
    last = &shard;
  }
  missing(sweep.end_index(), last == nullptr ? "" : absl::StrCat(", after ", last->Name()));
  return faults;
}

}  // namespace

absl::Status CheckCoverage(std::vector<ShardFile>& shards) {
  for (const ShardFile& shard : shards) {
    if (absl::Status status = CheckManifest(shard); !status.ok()) return status;
    if (absl::Status status = CheckSameSweep(shards.front(), shard); !status.ok()) return status;
  }
  std::sort(shards.begin(), shards.end(), [](const ShardFile& a, const ShardFile& b) {
    return std::pair(a.manifest.first_index(), a.manifest.end_index()) <
           std::pair(b.manifest.first_index(), b.manifest.end_index());
  });
  std::vector<std::string> faults = FaultsOf(shards);
  if (faults.empty()) return absl::OkStatus();
  if (faults.size() > kMostFaults) {
    const size_t more = faults.size() - kMostFaults;
    faults.resize(kMostFaults);
    faults.push_back(absl::StrCat("and ", Counted(more, "more fault")));
  }
  return absl::FailedPreconditionError(
      absl::StrCat("the shards do not make up the sweep:\n  ", absl::StrJoin(faults, "\n  ")));
}

}  // namespace ricochet::cli
