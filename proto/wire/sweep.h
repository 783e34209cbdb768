// Converts the requests and chunks of sweeps to their protos and back.

#ifndef RICOCHET_PROTO_WIRE_SWEEP_H_
#define RICOCHET_PROTO_WIRE_SWEEP_H_

#include <algorithm>
#include <bit>
#include <string>

#include "absl/types/span.h"
#include "proto/wire/enums.h"
#include "ricochet/sweep.h"
#include "ricochet/v1/sweep.pb.h"

namespace ricochet {

v1::SweepRequest ToProto(const SweepRequest& request);
SweepRequest FromProto(const v1::SweepRequest& proto);

void ToProto(const Tally& tally, v1::Tally& proto);
void FromProto(const v1::Tally& proto, Tally& tally);

// An unknown Combination keeps its number both ways, for ValidateAxes to report.
inline bool IsCombination(int /*number*/) { return true; }
template <>
struct EnumPair<Combination> : SameNumbers<v1::SweepRequest::Combination, IsCombination> {};

template <>
struct EnumPair<RowStatus> : SameNumbers<v1::RowStatus, v1::RowStatus_IsValid> {};

// Points with regimes that this build does not know are counted together as kUnspecified.
v1::SweepSummary ToProto(const SweepSummary& summary);
SweepSummary FromProto(const v1::SweepSummary& proto);
void ToProto(const SweepSummary& summary, v1::SweepSummary& proto);
void FromProto(const v1::SweepSummary& proto, SweepSummary& summary);

static_assert(std::endian::native == std::endian::little, "columns have the bytes of their doubles from the lowest on");

// Fills `doubles` from the first of `bytes`, which may lie at any address. Unlike memcpy, std::copy_n may be given the
// address of an empty span, which is null.
inline void CopyDoubles(const std::string& bytes, absl::Span<double> doubles) {
  std::copy_n(bytes.data(), doubles.size() * sizeof(double), reinterpret_cast<char*>(doubles.data()));
}

// Returns the regime or the status that a byte of a column has by its number. A number that this build does not know
// becomes kUnspecified.
template <typename Code>
Code CodeOf(char byte) {
  return FromProto<Code>(static_cast<typename EnumPair<Code>::Other>(static_cast<unsigned char>(byte)));
}

// Sets `bytes` to the numbers of regimes or statuses.
template <typename Codes>
void SetCodes(const Codes& codes, std::string& bytes) {
  bytes.resize(codes.size());
  std::transform(codes.begin(), codes.end(), bytes.begin(), [](auto code) { return static_cast<char>(code); });
}

// Sets or clears every field of `proto`, whose capacity is reused. The seal is cleared: proto/wire/chunk_seal.h puts it
// on.
void ToProto(const SweepChunk& chunk, v1::SweepResponse& proto);
// Values that end in the middle of a double lose its part.
SweepChunk FromProto(const v1::SweepResponse& proto);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_SWEEP_H_
