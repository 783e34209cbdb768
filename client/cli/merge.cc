#include <CLI/App.hpp>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/chunk_checker.h"
#include "client/cli/io/used_files.h"
#include "client/cli/program.h"
#include "client/cli/report/invalid_points.h"
#include "client/cli/sweep/shard.h"
#include "client/cli/sweep/shard_coverage.h"
#include "client/cli/sweep/sweep_output.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/terminal/progress.h"
#include "core/base/try.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: a sweep in three parts, which three machines may compute, and one file of them.
  $ for i in 0 1 2; do
  >   ricochet sweep --a 0.3 --b 1 --energetic 1 -o friction \
  >     --axis friction.kinetic_coefficient=lin:0:0.4:1000 \
  >     --column coefficients.newton --shard-index $i --shard-count 3
  > done
  $ ricochet merge --verify friction -o friction.csv
The file has the bytes of one run into a file of that name.
Exit codes: 0 done, 2 wrong input or shards of different sweeps, 42 a shard is missing, there twice or damaged,
130 interrupted.)";

struct MergeOptions {
  CommonOptions common;
  std::string file;
  bool verify = false;
};

// Puts the messages of all shards together as if they were calls of one sweep, each of which broke off.
class Merger {
 public:
  Merger(const SweepRequest& sweep, SweepOutput output, bool rows_to_terminal)
      : end_index_(*sweep.end_index),
        checker_(sweep),
        output_(std::move(output)),
        doubtful_(sweep),
        progress_(rows_to_terminal) {}

  // Errors: DATA_LOSS for a shard that is not what its manifest says; CANCELLED; those of the system.
  absl::Status Add(const ShardFile& shard) {
    RICOCHET_TRY(ShardReader reader, ShardReader::Open(shard));
    checker_.StartCall();
    while (true) {
      absl::StatusOr<std::optional<v1::SweepResponse>> message = reader.Next();
      if (!message.ok()) return Damaged(shard, message.status());
      if (!message->has_value()) break;
      if (absl::Status status = Write(shard, **message); !status.ok()) return status;
      if (Interrupt::Happened()) return absl::CancelledError("interrupted");
    }
    if (checker_.next_index() == shard.manifest.end_index()) return absl::OkStatus();
    return Damaged(shard, absl::DataLossError(absl::StrCat("it ends at point ", checker_.next_index(), " instead of ",
                                                           shard.manifest.end_index())));
  }

  absl::Status Finish() {
    if (absl::Status status = checker_.CheckEnd(); !status.ok()) return status;
    absl::Status written = output_.Commit();
    if (written.ok()) std::fputs(doubtful_.Text().c_str(), stderr);
    return written;
  }

 private:
  static absl::Status Damaged(const ShardFile& shard, const absl::Status& status) {
    return {status.code(), absl::StrCat(shard.Name(), ": ", status.message(), ": remove it and compute it anew")};
  }

  absl::Status Write(const ShardFile& shard, v1::SweepResponse& message) {
    // Files of shards have no summaries, and the last call of a sweep ends with one.
    const bool is_last = message.count() >= 0 && end_index_ - message.count() == message.first_index();
    if (is_last) *message.mutable_summary() = message.tallies();
    const absl::StatusOr<SweepChunk> chunk = checker_.Accept(message);
    if (!chunk.ok()) return Damaged(shard, chunk.status());
    progress_.Update(chunk->points_done, chunk->points_total);
    doubtful_.Add(*chunk);
    return output_.Write(*chunk);
  }

  int64_t end_index_;
  ChunkChecker checker_;
  SweepOutput output_;
  DoubtfulPoints doubtful_;
  Progress progress_;
};

absl::Status Verify(const std::vector<ShardFile>& shards) {
  int64_t bytes = 0;
  for (const ShardFile& shard : shards) {
    if (absl::Status status = CheckShardBytes(shard); !status.ok()) return status;
    bytes += shard.manifest.bytes();
  }
  const Shard& first = shards.front().manifest;
  std::fprintf(stderr, "%zu shards have each of the points %lld to %lld once, and the %lld bytes that were written.\n",
               shards.size(), static_cast<long long>(first.sweep().first_index()),
               static_cast<long long>(first.sweep().end_index()) - 1, static_cast<long long>(bytes));
  std::fprintf(stderr, "Grid %s, engine %s %s.\n", first.grid_fingerprint().c_str(), first.engine().version().c_str(),
               first.engine().fingerprint().c_str());
  return absl::OkStatus();
}

absl::Status RunMerge(const MergeOptions& options) {
  const Interrupt interrupt;
  RICOCHET_TRY(std::vector<ShardFile> shards, FindShardFiles(options.file));
  for (const ShardFile& shard : shards) {
    for (const std::string& path : {shard.path, shard.manifest_path()}) {
      if (absl::Status status = UseFile(FileUse::kRead, "", path); !status.ok()) return status;
    }
  }
  if (absl::Status status = CheckCoverage(shards); !status.ok()) return status;
  if (options.verify) {
    if (absl::Status status = Verify(shards); !status.ok()) return status;
  }
  const SweepRequest sweep = FromProto(shards.front().manifest.sweep());
  RICOCHET_TRY(SweepOutput output, SweepOutput::Open(sweep, options.common, /*summary_only=*/false));
  Merger merger(sweep, std::move(output), StreamsRows(options.common));
  const bool is_empty = sweep.first_index == *sweep.end_index;
  for (const ShardFile& shard : shards) {
    if (shard.manifest.rows() == 0 && !is_empty) continue;
    if (absl::Status status = merger.Add(shard); !status.ok()) return status;
    if (is_empty) break;
  }
  return merger.Finish();
}

}  // namespace

void AddMerge(CLI::App& app, Command& command) {
  const auto [sub, options] =
      AddCommand<MergeOptions>(app, "merge", "Put the shards of a sweep together", kExample, RunMerge, command);
  sub->add_option("file", options->file, "The -o FILE of the shards, which are the files FILE.shard-I-of-N")
      ->type_name("FILE")
      ->required();
  sub->add_flag(
      "--verify", options->verify,
      "Before anything is written, read every shard and compare it with the checksum of its manifest, and say "
      "what was found");
  AddOutputOptions(*sub, options->common, kSweepFormats);
}

}  // namespace ricochet::cli
