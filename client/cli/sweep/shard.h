// Shard files: the parts into which a sweep is divided, each a file FILE.shard-I-of-N with a manifest of its name and
// .json. proto/ricochet/cli/shard.proto says what is in them.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_SHARD_H_
#define RICOCHET_CLIENT_CLI_SWEEP_SHARD_H_

#include <google/protobuf/io/zero_copy_stream_impl.h>

#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/input/shard_input.h"
#include "proto/wire/chunk_seal.h"
#include "ricochet/cli/partial.pb.h"
#include "ricochet/cli/shard.pb.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet::cli {

// One shard of a sweep that is to be computed.
struct SweepShard {
  ShardNumber number;
  SweepRequest whole;  // The whole sweep; its end is set.
  SweepRequest part;   // The points of this shard.
  std::string path;    // The file of this shard.

  std::string manifest_path() const;
};

// Divides the sweep into ranges whose lengths differ by at most one point. `file` is the FILE of their names.
// Errors: those of a sweep; INVALID_ARGUMENT for an empty `file`.
absl::StatusOr<SweepShard> MakeShard(const SweepRequest& request, ShardNumber number, const std::string& file);

// True if the shard's file is there and complete.
// Errors: INVALID_ARGUMENT if it is of another sweep, DATA_LOSS if its bytes are not those of its manifest.
absl::StatusOr<bool> IsComplete(const SweepShard& shard);

// Writes the manifest of a shard of which `progress` tells all, before its file gets its name. Errors: those of the
// system.
absl::Status WriteShardManifest(const SweepShard& shard, const Partial& progress);

// Returns the bytes by which chunks of the sweep stand in a shard's file, without summaries: those are of the whole
// sweep.
class ShardWriter {
 public:
  explicit ShardWriter(const SweepRequest& request) : seal_(request) {}
  absl::StatusOr<std::string> operator()(const SweepChunk& chunk);

 private:
  ChunkSeal seal_;
  v1::SweepResponse message_;
};

// A shard's manifest as it was found, and the path of its file.
struct ShardFile {
  std::string path;
  Shard manifest;

  std::string manifest_path() const;
  // "shard 2 of 4 (sweep.shard-2-of-4)".
  std::string Name() const;
};

// Returns the shards FILE.shard-* that have a manifest, in the order of their names.
// Errors: NOT_FOUND if there is none; DATA_LOSS if a manifest cannot be read.
absl::StatusOr<std::vector<ShardFile>> FindShardFiles(const std::string& file);

// Compares the bytes of the file with its manifest. Errors: DATA_LOSS, NOT_FOUND.
absl::Status CheckShardBytes(const ShardFile& shard);

// Reads the messages of a shard's file.
class ShardReader {
 public:
  // Errors: NOT_FOUND.
  static absl::StatusOr<ShardReader> Open(const ShardFile& shard);

  // Returns the next message, or nothing at the end of the file. Errors: DATA_LOSS if the file breaks off.
  absl::StatusOr<std::optional<v1::SweepResponse>> Next();

 private:
  // The file does not move, because the stream of messages refers to it.
  struct Stream {
    explicit Stream(const std::string& path);
    std::ifstream file;
    google::protobuf::io::IstreamInputStream messages;
  };
  explicit ShardReader(std::unique_ptr<Stream> stream) : stream_(std::move(stream)) {}
  std::unique_ptr<Stream> stream_;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_SHARD_H_
