#include "client/cli/sweep/sweep_output.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/cli/terminal/progress.h"
#include "client/tally_checker.h"
#include "core/base/try.h"
#include "core/rows/checked_rows.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/engine.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

std::string Quoted(const std::string& argument) {
  const bool plain = !argument.empty() && std::all_of(argument.begin(), argument.end(), [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || absl::StrContains("-_./:=,@%+", c);
  });
  return plain ? argument : absl::StrCat("'", absl::StrReplaceAll(argument, {{"'", "'\\''"}}), "'");
}

// A checkpoint waits for the disk twice. A run that is killed loses at most the points of this interval.
constexpr std::chrono::milliseconds kBetweenCheckpoints{500};

Partial IdentityOf(const SweepRequest& request, const std::string& format) {
  Partial identity;
  identity.set_format(format);
  identity.set_grid_fingerprint(GridFingerprint(request));
  identity.set_first_index(request.first_index);
  if (request.end_index.has_value()) identity.set_end_index(*request.end_index);
  return identity;
}

// Returns how many points a table has, if the sweep is written as one.
absl::StatusOr<int64_t> PointsOfTable(const SweepRequest& request, const CommonOptions& options, bool summary_only) {
  if (options.format != Format::kText || summary_only) return 0;
  RICOCHET_TRY(const CheckedSweep checked, CheckSweep(request));
  return RowsOfTable(options, checked.end - checked.first);
}

}  // namespace

absl::StatusOr<SweepOutput> SweepOutput::Open(const SweepRequest& request, const CommonOptions& options,
                                              bool summary_only) {
  RICOCHET_TRY(const int64_t points, PointsOfTable(request, options, summary_only));
  SweepOutput output(MakeSweepWriter(request, options.format, summary_only, points));
  output.progress_.set_next_index(request.first_index);
  if (options.format == Format::kNetcdf) {
    RICOCHET_TRY(output.netcdf_, NetcdfFile::Create(request, options.output));
    return output;
  }
  RICOCHET_TRY(Output opened, Output::Open(options.output));
  output.output_.emplace(std::move(opened));
  return output;
}

absl::StatusOr<SweepOutput> SweepOutput::OpenPartial(const SweepRequest& request, const CommonOptions& options,
                                                     bool resume) {
  return OpenFile(request, options.output, FormatName(options.format), MakeSweepWriter(request, options.format),
                  resume);
}

absl::StatusOr<SweepOutput> SweepOutput::OpenShard(const SweepShard& shard) {
  absl::StatusOr<SweepOutput> output =
      OpenFile(shard.part, shard.path, "shard", ShardWriter(shard.whole), /*resume=*/true);
  if (output.ok()) output->shard_ = shard;
  return output;
}

absl::StatusOr<SweepOutput> SweepOutput::OpenFile(const SweepRequest& request, const std::string& path,
                                                  const std::string& format, SweepWriter writer, bool resume) {
  RICOCHET_TRY(PartialFile file, PartialFile::Open(path, IdentityOf(request, format), resume));
  SweepOutput output(std::move(writer));
  output.file_.emplace(std::move(file));
  output.progress_ = output.file_->manifest();
  output.earlier_ = FromProto(output.progress_.tallies());
  // The points that the manifest claims are in the file as if they had come in one chunk.
  const SweepChunk claimed = {.first_index = request.first_index,
                              .count = output.next_index() - request.first_index,
                              .tallies = output.earlier_};
  if (!TallyChecker().Check(claimed).ok()) {
    return absl::DataLossError(
        absl::StrCat("the manifest of ", output.file_->part_path(), " contradicts itself: remove both to start anew"));
  }
  return output;
}

absl::Status SweepOutput::Join(SweepChunk& chunk) {
  const EngineInfo before = FromProto(progress_.engine());
  if (progress_.has_engine() && chunk.engine.fingerprint != before.fingerprint) {
    return absl::FailedPreconditionError(
        absl::StrCat("the points before ", chunk.first_index, " come from the engine ", before.version, ", ",
                     before.fingerprint, ", those from there on from ", chunk.engine.version, ", ",
                     chunk.engine.fingerprint, ": they may differ in their last bits and must not be mixed"));
  }
  chunk.points_done += earlier_.points;
  chunk.points_total += earlier_.points;
  chunk.tallies = Joined(earlier_, chunk.tallies);
  if (chunk.summary.has_value() && earlier_.points > 0) chunk.summary = chunk.tallies;
  return absl::OkStatus();
}

absl::Status SweepOutput::Write(const SweepChunk& chunk) {
  // The text may come to the terminal: a table, or the counts of invalid points.
  if (chunk.summary.has_value()) Progress::Erase();
  if (netcdf_ != nullptr) return netcdf_->Write(chunk);
  RICOCHET_TRY(const std::string text, writer_(chunk));
  if (!file_.has_value()) return output_->Write(text);
  if (absl::Status status = file_->Write(text); !status.ok()) return status;
  progress_.set_next_index(chunk.first_index + chunk.count);
  *progress_.mutable_engine() = ToProto(chunk.engine);
  *progress_.mutable_tallies() = ToProto(chunk.tallies);
  // The last checkpoint is that of Commit.
  const Clock::time_point now = Clock::now();
  if (chunk.summary.has_value() || (checkpoint_.has_value() && now - *checkpoint_ < kBetweenCheckpoints)) {
    return absl::OkStatus();
  }
  checkpoint_ = now;
  return file_->Checkpoint(progress_);
}

absl::Status SweepOutput::Commit() {
  if (netcdf_ != nullptr) return netcdf_->Commit();
  if (!file_.has_value()) return output_->Commit();
  if (shard_.has_value()) {
    // The shard's manifest counts only bytes that are on the disk.
    if (absl::Status status = file_->Checkpoint(progress_); !status.ok()) return status;
    progress_.set_bytes(file_->bytes());
    progress_.set_crc32c(file_->crc32c());
    if (absl::Status status = WriteShardManifest(*shard_, progress_); !status.ok()) return status;
  }
  return file_->Commit();
}

void SweepOutput::LeaveForResume(const absl::Status& status, const std::string& command) {
  Progress::Erase();
  if (!file_.has_value()) return;
  if (!progress_.has_engine()) return file_->Discard();
  // If this fails, the earlier manifest stays valid, and the command below goes on from there.
  static_cast<void>(file_->Checkpoint(progress_));
  // If another engine has answered, the same command would be refused again.
  const std::string advice = absl::IsFailedPrecondition(status) ? "" : absl::StrCat(" To go on:\n  ", command);
  std::fprintf(stderr, "%s is the first part of the sweep, the points before %lld.%s\n", file_->part_path().c_str(),
               static_cast<long long>(file_->manifest().next_index()), advice.c_str());
}

std::string ResumeCommand(const std::vector<std::string>& arguments) {
  std::string command;
  for (const std::string& argument : arguments) {
    if (argument != "--resume") absl::StrAppend(&command, Quoted(argument), " ");
  }
  return command + "--resume";
}

}  // namespace ricochet::cli
