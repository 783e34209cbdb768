#include "proto/wire/chunk_seal.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <isa-l/crc.h>

#include <bit>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/numerics/stable_hash.h"
#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

static_assert(std::endian::native == std::endian::little, "the checksum is over little-endian bytes");
static_assert(sizeof(int) == 4, "the checksum is over regimes of four bytes");

// ISA-L neither inverts at the start nor at the end, so that its calls can be chained.
template <typename Number>
uint32_t AddToCrc(const google::protobuf::RepeatedField<Number>& numbers, uint32_t crc) {
  const auto bytes = static_cast<int>(numbers.size() * static_cast<int>(sizeof(Number)));
  // The function does not write to its buffer, although its type says so.
  return crc32_iscsi(const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(numbers.data())), bytes, crc);
}

std::string DeterministicBytes(const google::protobuf::Message& message) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    message.SerializeToCodedStream(&coded);
  }
  return bytes;
}

}  // namespace

int64_t Crc32cOf(const v1::SweepResponse& chunk) {
  return ~AddToCrc(chunk.regimes(), AddToCrc(chunk.values(), ~uint32_t{0}));
}

std::string GridFingerprint(const SweepRequest& request) {
  v1::SweepRequest proto = ToProto(request);
  proto.clear_first_index();
  proto.clear_end_index();
  StableHash hash;
  hash.Add(DeterministicBytes(proto));
  return absl::StrCat(absl::Hex(hash.value(), absl::kZeroPad16));
}

void ChunkSeal::Put(v1::SweepResponse& chunk) const {
  chunk.set_crc32c(Crc32cOf(chunk));
  chunk.set_grid_fingerprint(grid_fingerprint_);
}

absl::Status ChunkSeal::Check(const v1::SweepResponse& chunk) const {
  if (chunk.grid_fingerprint() != grid_fingerprint_) {
    return absl::DataLossError(
        absl::StrCat("the sweep's chunk at point ", chunk.first_index(), " answers the request with fingerprint \"",
                     absl::CEscape(chunk.grid_fingerprint()), "\", not \"", grid_fingerprint_, "\""));
  }
  const int64_t crc = Crc32cOf(chunk);
  if (chunk.crc32c() == crc) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the data of the sweep's chunk at point ", chunk.first_index(),
                                          " has the checksum ", crc, " instead of ", chunk.crc32c(),
                                          ": it was damaged on its way"));
}

}  // namespace ricochet
