// No conversion forgets, swaps or invents a field.

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <type_traits>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "core/scene/numbers.h"
#include "fill.h"
#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/fit.h"
#include "proto/wire/info.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/outcome.h"
#include "proto/wire/requests.h"
#include "proto/wire/scene.h"
#include "proto/wire/sweep.h"
#include "ricochet/audit_columns.h"
#include "ricochet/outcome_numbers.h"
#include "ricochet/v1/impact_service.pb.h"

namespace ricochet {
namespace {

// This is a multiple of the number of members of every oneof except Scene.system, whose eight members all occur too.
constexpr int kChoices = 12;

template <typename Message>
Message ThroughCore(const Message& proto) {
  return ToProto(FromProto(proto));
}

v1::SweepResponse ThroughCore(const v1::SweepResponse& proto) {
  v1::SweepResponse back;
  ToProto(FromProto(proto), back);
  // The core does not know the seal.
  back.set_crc32c(proto.crc32c());
  back.set_grid_fingerprint(proto.grid_fingerprint());
  return back;
}

template <typename Message>
class EveryFieldTest : public testing::Test {};

using Messages =
    testing::Types<v1::SolveRequest, v1::SolveResponse, v1::BoundsRequest, v1::BoundsResponse, v1::SweepRequest,
                   v1::SweepResponse, v1::AuditRequest, v1::AuditResponse, v1::AuditBatchRequest,
                   v1::AuditBatchResponse, v1::PlanRequest, v1::PlanResponse, v1::CostRequest, v1::CostResponse,
                   v1::BatchSetup, v1::BatchSummary, v1::MultiContactRequest, v1::MultiContactResponse, v1::FitRequest,
                   v1::FitResponse, v1::InfoRequest, v1::InfoResponse>;
TYPED_TEST_SUITE(EveryFieldTest, Messages);

TYPED_TEST(EveryFieldTest, SurvivesTheCore) {
  for (int choice = 0; choice < kChoices; ++choice) {
    TypeParam proto;
    Fill(choice, proto);
    google::protobuf::util::MessageDifferencer differencer;
    std::string differences;
    differencer.ReportDifferencesToString(&differences);
    EXPECT_TRUE(differencer.Compare(proto, ThroughCore(proto))) << differences;
  }
}

TYPED_TEST(EveryFieldTest, SurvivesTheCoreByteForByte) {
  TypeParam proto;
  Fill(0, proto);
  EXPECT_EQ(ThroughCore(proto).SerializeAsString(), proto.SerializeAsString());
}

TYPED_TEST(EveryFieldTest, ZeroIsNotAbsent) {
  for (int choice = 0; choice < kChoices; ++choice) {
    TypeParam proto;
    Fill(choice, proto);
    SetToZero(proto);
    EXPECT_EQ(ThroughCore(proto).SerializeAsString(), proto.SerializeAsString());
  }
}

// An audit knows each coefficient of its report.
template <typename Message>
constexpr bool kKnowsAll =
    std::is_same_v<Message, v1::AuditResponse> || std::is_same_v<Message, v1::AuditBatchResponse>;

TYPED_TEST(EveryFieldTest, WhatIsAbsentStaysAbsent) {
  if (kKnowsAll<TypeParam>) return;
  for (int choice = 0; choice < kChoices; ++choice) {
    TypeParam proto;
    Fill(choice, proto);
    MakeAbsent(proto);
    EXPECT_EQ(ThroughCore(proto).SerializeAsString(), proto.SerializeAsString());
  }
}

// Returns the number at a path, which is made of the names of the proto: "linkage.links[1].theta_rad".
double NumberAt(const std::string& path, const google::protobuf::Message& root) {
  const google::protobuf::Message* message = &root;
  for (const absl::string_view step : absl::StrSplit(path, '.')) {
    const std::pair<std::string, std::string> parts = absl::StrSplit(absl::StripSuffix(step, "]"), '[');
    const auto& reflection = *message->GetReflection();
    const auto* const field = message->GetDescriptor()->FindFieldByName(parts.first);
    int index = -1;
    if (field == nullptr || (!parts.second.empty() && !absl::SimpleAtoi(parts.second, &index))) break;
    if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_DOUBLE) {
      return index < 0 ? reflection.GetDouble(*message, field) : reflection.GetRepeatedDouble(*message, field, index);
    }
    message =
        index < 0 ? &reflection.GetMessage(*message, field) : &reflection.GetRepeatedMessage(*message, field, index);
  }
  ADD_FAILURE() << path << " names no number of " << root.GetTypeName();
  return std::nan("");
}

// A map that pairs two fields with the members of each other gives every message back. The names of the numbers tell.
TEST(NamesTest, EachNumberOfASceneArrivesInTheMemberOfItsName) {
  for (int choice = 0; choice < kChoices; ++choice) {
    v1::Scene proto;
    Fill(choice, proto);
    const Scene scene = FromProto(proto);
    VisitNumbers(scene, [&](const NumberPath& path, double number, NumberRule /*rule*/) {
      EXPECT_EQ(NumberAt(path.Text(), proto), number) << path.Text();
    });
  }
}

TEST(NamesTest, EachNumberOfAnOutcomeArrivesInTheMemberOfItsName) {
  v1::Outcome proto;
  Fill(0, proto);
  int numbers = 0;
  VisitOutcomeNumbers(FromProto(proto), [&](const NumberPath& path, double number) {
    EXPECT_EQ(NumberAt(path.Text(), proto), number) << path.Text();
    ++numbers;
  });
  EXPECT_GT(numbers, 40);
}

TEST(NamesTest, EachColumnOfAnAuditArrivesInTheMemberOfItsName) {
  v1::AuditBatchRequest proto;
  Fill(0, proto);
  const AuditBatchRequest request = FromProto(proto);
  for (const NamedAuditColumn& column : kAuditColumns) {
    EXPECT_EQ(NumberAt(absl::StrCat("columns.", column.name, "[0]"), proto), (request.columns.*column.values)[0]);
  }
}

// The messages above are all messages of the service, so that none is left untested.
TEST(EveryFieldTest, CoversEveryMessageOfTheService) {
  const auto& service = *v1::SolveRequest::descriptor()->file()->FindServiceByName("ImpactService");
  ASSERT_EQ(service.method_count(), 12);
  EXPECT_EQ(service.method(0)->input_type(), v1::SolveRequest::descriptor());
  EXPECT_EQ(service.method(0)->output_type(), v1::SolveResponse::descriptor());
  EXPECT_EQ(service.method(1)->input_type(), v1::BoundsRequest::descriptor());
  EXPECT_EQ(service.method(1)->output_type(), v1::BoundsResponse::descriptor());
  EXPECT_EQ(service.method(2)->input_type(), v1::SweepRequest::descriptor());
  EXPECT_EQ(service.method(2)->output_type(), v1::SweepResponse::descriptor());
  EXPECT_EQ(service.method(3)->input_type(), v1::AuditRequest::descriptor());
  EXPECT_EQ(service.method(3)->output_type(), v1::AuditResponse::descriptor());
  EXPECT_EQ(service.method(4)->input_type(), v1::AuditBatchRequest::descriptor());
  EXPECT_EQ(service.method(4)->output_type(), v1::AuditBatchResponse::descriptor());
  EXPECT_EQ(service.method(5)->input_type(), v1::PlanRequest::descriptor());
  EXPECT_EQ(service.method(5)->output_type(), v1::PlanResponse::descriptor());
  EXPECT_EQ(service.method(6)->input_type(), v1::CostRequest::descriptor());
  EXPECT_EQ(service.method(6)->output_type(), v1::CostResponse::descriptor());
  // Batches hold columns as bytes; tests/proto/batch_test.cc looks after them.
  for (const int method : {7, 8}) {
    EXPECT_EQ(service.method(method)->input_type(), v1::SolveBatchRequest::descriptor());
    EXPECT_EQ(service.method(method)->output_type(), v1::SolveBatchResponse::descriptor());
  }
  EXPECT_EQ(service.method(9)->input_type(), v1::MultiContactRequest::descriptor());
  EXPECT_EQ(service.method(9)->output_type(), v1::MultiContactResponse::descriptor());
  EXPECT_EQ(service.method(10)->input_type(), v1::FitRequest::descriptor());
  EXPECT_EQ(service.method(10)->output_type(), v1::FitResponse::descriptor());
  EXPECT_EQ(service.method(11)->input_type(), v1::InfoRequest::descriptor());
  EXPECT_EQ(service.method(11)->output_type(), v1::InfoResponse::descriptor());
}

TEST(FillTest, ReachesEveryMemberOfEveryOneof) {
  std::set<const google::protobuf::FieldDescriptor*> reached;
  std::set<const google::protobuf::FieldDescriptor*> all;
  for (const auto* message : {v1::Scene::descriptor(), v1::BodyPair::descriptor(), v1::SpeedDependence::descriptor(),
                              v1::Restitution::descriptor(), v1::Compliance::descriptor(),
                              v1::AuditRequest::descriptor(), v1::MultiContactScene::descriptor()}) {
    for (int i = 0; i < message->real_oneof_decl_count(); ++i) {
      const auto* oneof = message->oneof_decl(i);
      for (int k = 0; k < oneof->field_count(); ++k) all.insert(oneof->field(k));
      for (int choice = 0; choice < kChoices; ++choice) reached.insert(oneof->field(choice % oneof->field_count()));
    }
  }
  EXPECT_EQ(reached, all);
  EXPECT_EQ(all.size(), 8U + 4U + 3U + 2U + 2U + 3U + 3U + 2U + 3U);
}

TEST(FillTest, SetsEveryFieldButTheOtherMembersOfAOneof) {
  v1::SweepRequest request;
  Fill(1, request);
  EXPECT_EQ(request.scene().restitution().coefficient_case(), v1::Restitution::kPoisson);
  ASSERT_EQ(request.axes_size(), 2);
  EXPECT_EQ(request.axes(1).values_case(), v1::Axis::kLinspace);
  EXPECT_NE(request.axes(0).linspace().start(), request.axes(1).linspace().start());
  EXPECT_EQ(request.columns_size(), 2);
  EXPECT_TRUE(request.has_end_index());
  EXPECT_NE(request.combination(), v1::SweepRequest::COMBINATION_UNSPECIFIED);
}

}  // namespace
}  // namespace ricochet
