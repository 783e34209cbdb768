// SweepOutput: where the text of a sweep goes. It is an Output, or a PartialFile with which another run can go on.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SWEEP_OUTPUT_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SWEEP_OUTPUT_H_

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/input/command_options.h"
#include "client/cli/io/output.h"
#include "client/cli/io/partial_file.h"
#include "client/cli/sweep/netcdf_file.h"
#include "client/cli/sweep/shard.h"
#include "client/cli/sweep/sweep_writer.h"
#include "ricochet/sweep.h"

namespace ricochet::cli {

// True if the rows of a sweep come to standard output one after the other.
inline bool StreamsRows(const CommonOptions& options) {
  return options.output.empty() && options.format != Format::kText;
}

class SweepOutput {
 public:
  // Errors: those of RowsOfTable, Output::Open, NetcdfFile::Create and PartialFile::Open.
  static absl::StatusOr<SweepOutput> Open(const SweepRequest& request, const CommonOptions& options, bool summary_only);
  static absl::StatusOr<SweepOutput> OpenPartial(const SweepRequest& request, const CommonOptions& options,
                                                 bool resume);
  // Goes on with an unfinished shard if there is one.
  static absl::StatusOr<SweepOutput> OpenShard(const SweepShard& shard);

  // The first point that the output does not have.
  int64_t next_index() const { return progress_.next_index(); }

  // Adds what earlier runs have done to the counts of a chunk that starts at or after next_index().
  // Errors: FAILED_PRECONDITION if its engine is not theirs.
  absl::Status Join(SweepChunk& chunk);

  // Writes the next chunk, which Join has taken. Errors: those of the system.
  absl::Status Write(const SweepChunk& chunk);

  // Makes a file appear under its name, after the manifest if it is a shard. Errors: those of the system.
  absl::Status Commit();

  // Ends a run that failed with `status`. A partial file is left if there are points in it, and `command` is shown if
  // that may go on.
  void LeaveForResume(const absl::Status& status, const std::string& command);

 private:
  using Clock = std::chrono::steady_clock;
  explicit SweepOutput(SweepWriter writer) : writer_(std::move(writer)) {}

  // `format` is that of the manifest.
  static absl::StatusOr<SweepOutput> OpenFile(const SweepRequest& request, const std::string& path,
                                              const std::string& format, SweepWriter writer, bool resume);

  SweepWriter writer_;  // None for NetCDF, which is no text.
  std::optional<SweepShard> shard_;
  std::optional<Output> output_;
  std::unique_ptr<NetcdfFile> netcdf_;
  std::optional<PartialFile> file_;
  Partial progress_;      // The manifest of all that was written.
  SweepSummary earlier_;  // The counts of earlier runs.
  std::optional<Clock::time_point> checkpoint_;
};

// Returns the command line that goes on with an unfinished sweep: `arguments`, the name of the program first, with
// --resume, quoted for a shell.
std::string ResumeCommand(const std::vector<std::string>& arguments);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SWEEP_OUTPUT_H_
