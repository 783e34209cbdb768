// Fuzzes the conversions between protos and the core. The first byte says which message the others are.
//
// It checks that every message can be converted proto -> core -> proto -> core -> proto and that the last two protos
// have the same bytes; that fields which the parser does not know are found; and that an error that was sent once can
// be sent again unchanged.
//
// tests/fuzz/run.sh lists the code that it covers.

#include <grpcpp/support/status.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "absl/status/status.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/message_content.h"
#include "proto/wire/requests.h"
#include "proto/wire/status.h"
#include "proto/wire/sweep.h"
#include "ricochet/v1/impact_service.pb.h"
#include "tests/fuzz/fail.h"

namespace ricochet {
namespace {

v1::SweepResponse ToProto(const SweepChunk& chunk) {
  v1::SweepResponse proto;
  ricochet::ToProto(chunk, proto);
  return proto;
}

// A field that the parser has put aside is found in the bytes. More may be found there: of two members of a oneof, it
// forgets the first with all that is in it.
template <typename Message>
void CheckUnknownFields(const std::string& bytes, const Message& proto) {
  Message known = proto;
  known.DiscardUnknownFields();
  if (known.ByteSizeLong() == proto.ByteSizeLong()) return;
  constexpr int64_t kAnyNumber = std::numeric_limits<int64_t>::max();
  if (CheckContent(bytes, *Message::descriptor(), kAnyNumber).ok()) {
    Fail("a field that is unknown is not found: " + proto.ShortDebugString());
  }
}

template <typename Message>
void CheckMessage(const std::string& bytes) {
  Message proto;
  if (!proto.ParseFromString(bytes)) return;
  CheckUnknownFields(bytes, proto);
  const Message once = ToProto(FromProto(proto));
  const Message twice = ToProto(FromProto(once));
  if (once.SerializeAsString() != twice.SerializeAsString()) Fail("a second conversion changes " + once.GetTypeName());
}

// Status codes that gRPC does not define are included, because a broken server may send them.
void CheckError(const std::string& bytes) {
  const int code = bytes.empty() ? 3 : static_cast<unsigned char>(bytes[0]) % 32;
  const absl::Status once = FromGrpcStatus(grpc::Status(static_cast<grpc::StatusCode>(code), "message", bytes));
  const absl::Status twice = FromGrpcStatus(ToGrpcStatus(once));
  if (once.code() != twice.code() || once.message() != twice.message()) {
    Fail("an error changes: " + once.ToString() + " becomes " + twice.ToString());
  }
}

constexpr void (*kChecks[])(const std::string&) = {
    CheckMessage<v1::SolveRequest>,
    CheckMessage<v1::SolveResponse>,
    CheckMessage<v1::BoundsRequest>,
    CheckMessage<v1::BoundsResponse>,
    CheckMessage<v1::AuditRequest>,
    CheckMessage<v1::AuditResponse>,
    CheckMessage<v1::AuditBatchRequest>,
    CheckMessage<v1::AuditBatchResponse>,
    CheckMessage<v1::BatchSetup>,
    CheckMessage<v1::BatchSummary>,
    CheckMessage<v1::SweepRequest>,
    CheckMessage<v1::SweepResponse>,
    CheckError,
    CheckMessage<v1::CostRequest>,
    CheckMessage<v1::CostResponse>,
};

}  // namespace
}  // namespace ricochet

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  ricochet::kChecks[data[0] % std::size(ricochet::kChecks)](bytes);
  return 0;
}
