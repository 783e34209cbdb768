// The conversion absl::Status -> grpc::Status -> absl::Status loses nothing, unless a status is too large for a
// trailer.

#include "proto/wire/status.h"

#include <gmock/gmock.h>
#include <google/protobuf/any.pb.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "ricochet/error.h"
#include "ricochet/v1/error_reason.pb.h"
#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr size_t kTrailersLimit = 8192;

google::rpc::Status DetailsOf(const grpc::Status& status) {
  google::rpc::Status proto;
  EXPECT_TRUE(proto.ParseFromString(status.error_details()));
  return proto;
}

template <typename Detail>
std::vector<Detail> DetailsOfType(const grpc::Status& status) {
  std::vector<Detail> found;
  Detail detail;
  const google::rpc::Status details = DetailsOf(status);
  for (const google::protobuf::Any& any : details.details()) {
    if (any.UnpackTo(&detail)) found.push_back(detail);
  }
  return found;
}

// Returns the size of the trailers grpc-message, percent-encoded, and grpc-status-details-bin, in base64.
size_t TrailersSize(const grpc::Status& status) {
  size_t size = status.error_details().size() / 3 * 4 + 4;
  for (const char c : status.error_message()) size += c >= ' ' && c <= '~' && c != '%' ? 1 : 3;
  return size;
}

void ExpectSame(const absl::Status& actual, const absl::Status& expected) {
  EXPECT_EQ(actual.code(), expected.code());
  EXPECT_EQ(actual.message(), expected.message());
  EXPECT_EQ(ReasonOf(actual), ReasonOf(expected));
  EXPECT_EQ(ViolationsOf(actual), ViolationsOf(expected));
  EXPECT_EQ(RetryDelayOf(actual), RetryDelayOf(expected));
}

void ExpectSurvives(const absl::Status& status) { ExpectSame(FromGrpcStatus(ToGrpcStatus(status)), status); }

std::vector<Violation> ManyViolations(int count) {
  std::vector<Violation> violations;
  for (int i = 0; i < count; ++i) {
    violations.push_back(MakeViolation(absl::StrCat("axes[", i, "].linspace.count"), -1.0 - i, "be >= 1"));
  }
  return violations;
}

// Violations of which fewer fit than a status lists.
std::vector<Violation> LongViolations(int count) {
  std::vector<Violation> violations = ManyViolations(count);
  for (Violation& violation : violations) violation.description += std::string(300, 'x');
  return violations;
}

TEST(StatusTest, OkIsOk) {
  EXPECT_TRUE(ToGrpcStatus(absl::OkStatus()).ok());
  EXPECT_TRUE(FromGrpcStatus(grpc::Status::OK).ok());
}

TEST(StatusTest, EveryCodeKeepsItsNumberAndMessage) {
  for (int code = 1; code <= 16; ++code) {
    const absl::Status status(static_cast<absl::StatusCode>(code), "the message");
    EXPECT_EQ(ToGrpcStatus(status).error_code(), code);
    ExpectSurvives(status);
  }
}

TEST(StatusTest, StatusWithoutFactsHasNoDetails) {
  EXPECT_THAT(ToGrpcStatus(absl::NotFoundError("gone")).error_details(), IsEmpty());
}

TEST(StatusTest, EveryReasonTravelsByItsNameWithoutThePrefix) {
  const google::protobuf::EnumDescriptor& type = *v1::ErrorReason_descriptor();
  ASSERT_EQ(type.value_count(), 13);
  for (int i = 1; i < type.value_count(); ++i) {
    const auto reason = static_cast<ErrorReason>(type.value(i)->number());
    const absl::Status error = MakeError(absl::StatusCode::kOutOfRange, reason, "message");
    const auto infos = DetailsOfType<google::rpc::ErrorInfo>(ToGrpcStatus(error));
    ASSERT_EQ(infos.size(), 1) << type.value(i)->name();
    EXPECT_EQ("ERROR_REASON_" + infos[0].reason(), type.value(i)->name());
    EXPECT_EQ(infos[0].domain(), "ricochet");
    ExpectSurvives(error);
  }
}

TEST(StatusTest, DetailsRepeatCodeAndMessage) {
  const grpc::Status status = ToGrpcStatus(InvalidRequest({{"scene", "= unset: must be set"}}));
  EXPECT_EQ(DetailsOf(status).code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(DetailsOf(status).message(), "scene = unset: must be set");
  EXPECT_EQ(status.error_message(), "scene = unset: must be set");
}

TEST(StatusTest, ViolationsKeepTheirPaths) {
  const absl::Status error = InvalidRequest({MakeViolation("friction.kinetic_coefficient", -0.1, "be >= 0"),
                                             MakeViolation("axes[0].linspace.count", 0, "be >= 1")});
  const auto requests = DetailsOfType<google::rpc::BadRequest>(ToGrpcStatus(error));
  ASSERT_EQ(requests.size(), 1);
  ASSERT_EQ(requests[0].field_violations_size(), 2);
  EXPECT_EQ(requests[0].field_violations(0).field(), "friction.kinetic_coefficient");
  EXPECT_EQ(requests[0].field_violations(0).description(), "= -0.1: must be >= 0");
  EXPECT_EQ(requests[0].field_violations(1).field(), "axes[0].linspace.count");
  ExpectSurvives(error);
}

TEST(StatusTest, RetryDelaySurvives) {
  for (const int delay : {0, 1, 999, 1000, 61'001, 2'000'000'000}) {
    absl::Status error = MakeError(absl::StatusCode::kUnavailable, ErrorReason::kDraining, "shutting down");
    SetRetryDelay(milliseconds(delay), error);
    ExpectSurvives(error);
  }
}

TEST(StatusTest, RetryDelayTravelsAsADuration) {
  absl::Status error = absl::ResourceExhaustedError("busy");
  SetRetryDelay(milliseconds(2500), error);
  const auto retries = DetailsOfType<google::rpc::RetryInfo>(ToGrpcStatus(error));
  ASSERT_EQ(retries.size(), 1);
  EXPECT_EQ(retries[0].retry_delay().seconds(), 2);
  EXPECT_EQ(retries[0].retry_delay().nanos(), 500'000'000);
}

absl::Status FromDetail(const google::protobuf::Message& detail) {
  google::rpc::Status proto;
  proto.add_details()->PackFrom(detail);
  return FromGrpcStatus({grpc::StatusCode::RESOURCE_EXHAUSTED, "busy", proto.SerializeAsString()});
}

TEST(StatusTest, RetryDelayOfAnotherServiceIsRoundedUp) {
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_nanos(1'000'001);
  EXPECT_EQ(RetryDelayOf(FromDetail(retry)), milliseconds(2));
}

TEST(StatusTest, RetryDelayOutsideTheRangeOfADurationIsClamped) {
  google::rpc::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(std::numeric_limits<int64_t>::max());
  EXPECT_EQ(RetryDelayOf(FromDetail(retry)), milliseconds(315'576'000'000'000));
  retry.mutable_retry_delay()->set_seconds(std::numeric_limits<int64_t>::min());
  EXPECT_EQ(RetryDelayOf(FromDetail(retry)), milliseconds(0));
}

TEST(StatusTest, ReasonOfAnotherDomainIsNone) {
  google::rpc::ErrorInfo info;
  info.set_reason("INVALID_REQUEST");
  info.set_domain("example.com");
  EXPECT_EQ(ReasonOf(FromDetail(info)), ErrorReason::kUnspecified);
  info.set_domain("ricochet");
  EXPECT_EQ(ReasonOf(FromDetail(info)), ErrorReason::kInvalidRequest);
}

TEST(StatusTest, UnknownReasonIsNone) {
  google::rpc::ErrorInfo info;
  info.set_reason("MOON_IN_THE_WRONG_PHASE");
  info.set_domain("ricochet");
  const absl::Status status = FromDetail(info);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kUnspecified);
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(status.message(), "busy");
}

TEST(StatusTest, UnreadableDetailsAreIgnored) {
  const absl::Status status = FromGrpcStatus({grpc::StatusCode::INTERNAL, "proxy failed", "\xff\xff\xff not a proto"});
  ExpectSame(status, absl::InternalError("proxy failed"));
}

TEST(StatusTest, CodeOutsideTheListIsUnknown) {
  EXPECT_EQ(FromGrpcStatus({grpc::StatusCode::DO_NOT_USE, "?"}).code(), absl::StatusCode::kUnknown);
}

TEST(StatusTest, TwentyViolationsSurviveWhole) { ExpectSurvives(InvalidRequest(ManyViolations(20))); }

TEST(StatusTest, AThousandViolationsAreCut) {
  const std::vector<Violation> all = ManyViolations(1000);
  const grpc::Status status = ToGrpcStatus(InvalidRequest(all));
  EXPECT_LE(status.error_details().size(), 4096);
  EXPECT_LE(TrailersSize(status), kTrailersLimit - 512);

  const absl::Status back = FromGrpcStatus(status);
  const std::vector<Violation> kept = ViolationsOf(back);
  ASSERT_EQ(kept.size(), kMostViolations);
  const std::string note = " (and more violations)";
  for (size_t i = 0; i + 1 < kept.size(); ++i) EXPECT_EQ(kept[i], all[i]);
  EXPECT_EQ(kept.back().field, all[kept.size() - 1].field);
  EXPECT_EQ(kept.back().description, all[kept.size() - 1].description + note);
  EXPECT_EQ(ReasonOf(back), ErrorReason::kInvalidRequest);
  EXPECT_EQ(back.message(), InvalidRequest(kept).message());
}

TEST(StatusTest, AsManyViolationsAreKeptAsFit) {
  int most = 0;
  while (ViolationsOf(FromGrpcStatus(ToGrpcStatus(InvalidRequest(LongViolations(most + 1))))) ==
         LongViolations(most + 1)) {
    ++most;
  }
  ASSERT_LT(most, 20);
  const std::vector<Violation> all = LongViolations(20);
  const auto cut = ViolationsOf(FromGrpcStatus(ToGrpcStatus(InvalidRequest(all))));
  EXPECT_GE(static_cast<int>(cut.size()), most - 1);
  EXPECT_LE(static_cast<int>(cut.size()), most);
  EXPECT_EQ(cut.back().description, all[cut.size() - 1].description + " (and more violations)");
}

TEST(StatusTest, AHugeViolationIsCutAndCounted) {
  const std::string path(100'000, '\x01');
  const grpc::Status status = ToGrpcStatus(InvalidRequest({{path, path}, {path, path}}));
  EXPECT_LE(TrailersSize(status), kTrailersLimit - 512);
  const std::vector<Violation> kept = ViolationsOf(FromGrpcStatus(status));
  ASSERT_EQ(kept.size(), 1);
  EXPECT_LE(kept[0].field.size(), 200);
  EXPECT_THAT(kept[0].field, EndsWith(" more bytes)"));
  EXPECT_THAT(kept[0].description, AllOf(HasSubstr(" more bytes)"), EndsWith("(and more violations)")));
}

TEST(StatusTest, ALongMessageIsCutAndCounted) {
  const absl::Status error =
      MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow, std::string(100'000, 'x'));
  const grpc::Status status = ToGrpcStatus(error);
  EXPECT_LE(TrailersSize(status), kTrailersLimit - 512);
  EXPECT_GT(status.error_message().size(), 2000);
  EXPECT_THAT(status.error_message(), AllOf(StartsWith("xxx"), EndsWith(" more bytes)")));
  const absl::Status back = FromGrpcStatus(status);
  EXPECT_EQ(back.message(), status.error_message());
  EXPECT_EQ(ReasonOf(back), ErrorReason::kOutputOverflow);
}

TEST(StatusTest, ALongMessageIsNotCutInsideACharacter) {
  for (int offset = 0; offset < 3; ++offset) {
    std::string text(static_cast<size_t>(offset), 'x');
    for (int i = 0; i < 10'000; ++i) text += "€";
    const absl::Status error = MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow, text);
    const grpc::Status status = ToGrpcStatus(error);
    EXPECT_LE(TrailersSize(status), kTrailersLimit - 512);
    const size_t cut = status.error_message().find("...");
    ASSERT_NE(cut, std::string::npos);
    EXPECT_EQ((cut - static_cast<size_t>(offset)) % 3, 0);
    EXPECT_EQ(ReasonOf(FromGrpcStatus(status)), ErrorReason::kOutputOverflow);
  }
}

// A service that fails every call with one status.
class FailingService final : public v1::ImpactService::Service {
 public:
  explicit FailingService(absl::Status status) : status_(std::move(status)) {}

  grpc::Status Solve(grpc::ServerContext* /*context*/, const v1::SolveRequest* /*request*/,
                     v1::SolveResponse* /*response*/) override {
    return ToGrpcStatus(status_);
  }

 private:
  const absl::Status status_;
};

absl::Status OverAConnection(const absl::Status& status) {
  FailingService service(status);
  int port = 0;
  grpc::ServerBuilder builder;
  builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
  builder.RegisterService(&service);
  const std::unique_ptr<grpc::Server> server = builder.BuildAndStart();
  const auto stub = v1::ImpactService::NewStub(
      grpc::CreateChannel(absl::StrCat("127.0.0.1:", port), grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  v1::SolveResponse response;
  return FromGrpcStatus(stub->Solve(&context, v1::SolveRequest(), &response));
}

TEST(StatusTest, CrossesAConnection) {
  absl::Status error = InvalidRequest(ManyViolations(10));
  SetRetryDelay(milliseconds(1500), error);
  ExpectSame(OverAConnection(error), error);
}

TEST(StatusTest, WhatIsCutCrossesAConnection) {
  const std::string bytes(10'000, '\x01');
  for (const absl::Status& error : {InvalidRequest(LongViolations(1000)), InvalidRequest({{bytes, bytes}}),
                                    MakeError(absl::StatusCode::kOutOfRange, ErrorReason::kOutputOverflow, bytes)}) {
    const absl::Status cut = FromGrpcStatus(ToGrpcStatus(error));
    EXPECT_THAT(std::string(cut.message()), Not(std::string(error.message())));
    ExpectSame(OverAConnection(error), cut);
  }
}

}  // namespace
}  // namespace ricochet
