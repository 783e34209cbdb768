#include "client/cli/sweep/shard.h"

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/io/output.h"
#include "core/base/try.h"
#include "core/rows/checked_rows.h"
#include "proto/wire/chunk_seal.h"
#include "proto/wire/crc32c.h"
#include "proto/wire/sweep.h"

namespace ricochet::cli {
namespace {

constexpr char kManifestEnding[] = ".json";

// Equal widths let a listing show the shards in their order.
std::string ShardPath(const std::string& file, ShardNumber number) {
  const auto width = static_cast<int>(absl::StrCat(number.count - 1).size());
  return absl::StrFormat("%s.shard-%0*d-of-%d", file, width, number.index, number.count);
}

absl::StatusOr<ShardFile> ReadManifest(const std::string& path) {
  ShardFile shard = {.path = path, .manifest = {}};
  std::ifstream file(path + kManifestEnding);
  if (!file.is_open()) {
    return absl::DataLossError(absl::StrCat("the manifest ", path, kManifestEnding, " cannot be read: remove ", path,
                                            " and compute the shard anew"));
  }
  std::ostringstream text;
  text << file.rdbuf();
  const auto read = google::protobuf::util::JsonStringToMessage(text.str(), &shard.manifest);
  if (read.ok()) return shard;
  return absl::DataLossError(absl::StrCat(path, kManifestEnding, " is no manifest of a shard: ", read.ToString()));
}

// Returns the first point of a shard. If the division has a remainder, the first shards have one point more.
int64_t StartOf(int64_t index, int64_t count, int64_t points) {
  return index * (points / count) + std::min(index, points % count);
}

}  // namespace

absl::StatusOr<SweepShard> MakeShard(const SweepRequest& request, ShardNumber number, const std::string& file) {
  if (file.empty()) return absl::InvalidArgumentError("a shard needs -o FILE: it is written to FILE.shard-I-of-N");
  RICOCHET_TRY(const CheckedSweep checked, CheckSweep(request));
  const int64_t points = checked.end - checked.first;
  SweepShard shard = {.number = number, .whole = request, .part = request, .path = ShardPath(file, number)};
  shard.whole.end_index = request.first_index + points;
  shard.part.first_index = request.first_index + StartOf(number.index, number.count, points);
  shard.part.end_index = request.first_index + StartOf(number.index + 1, number.count, points);
  return shard;
}

absl::StatusOr<bool> IsComplete(const SweepShard& shard) {
  std::error_code ignored;
  if (!std::filesystem::exists(shard.path, ignored)) return false;
  RICOCHET_TRY(const ShardFile found, ReadManifest(shard.path));
  const Shard& manifest = found.manifest;
  if (manifest.grid_fingerprint() != GridFingerprint(shard.whole) || manifest.first_index() != shard.part.first_index ||
      manifest.end_index() != shard.part.end_index || FromProto(manifest.sweep()) != shard.whole) {
    return absl::InvalidArgumentError(
        absl::StrCat(found.Name(), " is of another sweep than the one asked for: name another file, or remove it"));
  }
  if (absl::Status status = CheckShardBytes(found); !status.ok()) return status;
  return true;
}

absl::Status WriteShardManifest(const SweepShard& shard, const Partial& progress) {
  Shard manifest;
  manifest.set_shard_index(shard.number.index);
  manifest.set_shard_count(shard.number.count);
  manifest.set_first_index(shard.part.first_index);
  manifest.set_end_index(*shard.part.end_index);
  manifest.set_rows(progress.next_index() - shard.part.first_index);
  manifest.set_bytes(progress.bytes());
  manifest.set_crc32c(progress.crc32c());
  manifest.set_grid_fingerprint(progress.grid_fingerprint());
  *manifest.mutable_engine() = progress.engine();
  *manifest.mutable_tallies() = progress.tallies();
  *manifest.mutable_sweep() = ToProto(shard.whole);
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(manifest, &text, options);
  if (!status.ok()) return absl::InternalError(status.ToString());
  return WriteFile(shard.manifest_path(), text);
}

absl::StatusOr<std::string> ShardWriter::operator()(const SweepChunk& chunk) {
  ToProto(chunk, message_);
  message_.clear_summary();
  seal_.Put(message_);
  std::string bytes;
  google::protobuf::io::StringOutputStream stream(&bytes);
  if (!google::protobuf::util::SerializeDelimitedToZeroCopyStream(message_, &stream)) {
    return absl::InternalError("a chunk cannot be written as bytes");
  }
  return bytes;
}

std::string SweepShard::manifest_path() const { return path + kManifestEnding; }

std::string ShardFile::manifest_path() const { return path + kManifestEnding; }

std::string ShardFile::Name() const {
  return absl::StrCat("shard ", manifest.shard_index(), " of ", manifest.shard_count(), " (", path, ")");
}

absl::StatusOr<std::vector<ShardFile>> FindShardFiles(const std::string& file) {
  const std::filesystem::path target = file;
  const std::filesystem::path directory = target.has_parent_path() ? target.parent_path() : ".";
  const std::string beginning = target.filename().string() + ".shard-";
  std::vector<std::string> paths;
  std::error_code failure;
  // A folder that cannot be read to its end must not pass for one with fewer shards.
  for (auto entry = std::filesystem::directory_iterator(directory, failure);
       !failure && entry != std::filesystem::directory_iterator(); entry.increment(failure)) {
    const std::string name = entry->path().filename();
    if (!absl::StartsWith(name, beginning) || !absl::EndsWith(name, kManifestEnding)) continue;
    if (absl::EndsWith(name, absl::StrCat(".part", kManifestEnding))) continue;
    const std::string path = (target.parent_path() / name).string();
    paths.push_back(path.substr(0, path.size() - std::string_view(kManifestEnding).size()));
  }
  if (failure && failure != std::errc::no_such_file_or_directory) {
    return absl::ErrnoToStatus(failure.value(), absl::StrCat("cannot read the folder ", directory.string()));
  }
  if (paths.empty()) {
    return absl::NotFoundError(absl::StrCat("there is no finished shard ", file, ".shard-I-of-N with its manifest"));
  }
  std::sort(paths.begin(), paths.end());
  std::vector<ShardFile> shards;
  for (const std::string& path : paths) {
    RICOCHET_TRY(ShardFile shard, ReadManifest(path));
    shards.push_back(std::move(shard));
  }
  return shards;
}

absl::Status CheckShardBytes(const ShardFile& shard) {
  std::ifstream file(shard.path, std::ios::binary);
  if (!file) return absl::NotFoundError(absl::StrCat("cannot read ", shard.Name()));
  std::string buffer(1 << 20, '\0');
  int64_t bytes = 0;
  uint32_t crc = 0;
  while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || file.gcount() > 0) {
    const std::string_view read(buffer.data(), static_cast<size_t>(file.gcount()));
    crc = ExtendCrc32c(crc, read);
    bytes += static_cast<int64_t>(read.size());
  }
  if (bytes == shard.manifest.bytes() && crc == shard.manifest.crc32c()) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat(shard.Name(), " has ", bytes, " bytes with the checksum ", crc,
                                          ", its manifest says ", shard.manifest.bytes(), " bytes with ",
                                          shard.manifest.crc32c(), ": remove it and compute it anew"));
}

ShardReader::Stream::Stream(const std::string& path) : file(path, std::ios::binary), messages(&file, 1 << 20) {}

absl::StatusOr<ShardReader> ShardReader::Open(const ShardFile& shard) {
  auto stream = std::make_unique<Stream>(shard.path);
  if (!stream->file) return absl::NotFoundError(absl::StrCat("cannot read ", shard.Name()));
  return ShardReader(std::move(stream));
}

absl::StatusOr<std::optional<v1::SweepResponse>> ShardReader::Next() {
  std::optional<v1::SweepResponse> message(std::in_place);
  bool at_end = false;
  if (google::protobuf::util::ParseDelimitedFromZeroCopyStream(&*message, &stream_->messages, &at_end)) return message;
  if (at_end) return std::nullopt;
  return absl::DataLossError("breaks off, or was changed");
}

}  // namespace ricochet::cli
