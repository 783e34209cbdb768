// Every enum value converts to the same number in both directions.

#include <google/protobuf/descriptor.h>
#include <google/protobuf/generated_enum_reflection.h>
#include <gtest/gtest.h>

#include "proto/wire/audit.h"
#include "proto/wire/batch.h"
#include "proto/wire/cost.h"
#include "proto/wire/fit.h"
#include "proto/wire/multi_contact.h"
#include "proto/wire/outcome.h"
#include "proto/wire/plan.h"
#include "proto/wire/sweep.h"

namespace ricochet {
namespace {

using google::protobuf::EnumDescriptor;

template <typename Enum>
class EnumTest : public testing::Test {};

using Enums =
    testing::Types<Regime, EventKind, LimitKind, AccuracyKind, Verdict, Combination, Termination, Effect, Model,
                   Arithmetic, Decision, ArithmeticReason, CostStatus, RowStatus, MultiContactMethod, MultiContactEnd,
                   MultiContactVerdict, DerivativeKind, Threshold, FitLoss, FitEndKind, AuditLimit>;
TYPED_TEST_SUITE(EnumTest, Enums);

TYPED_TEST(EnumTest, EveryValueOfTheProtoIsTheCoresOfTheSameNumber) {
  using Proto = typename EnumPair<TypeParam>::Other;
  const EnumDescriptor& type = *google::protobuf::GetEnumDescriptor<Proto>();
  ASSERT_GE(type.value_count(), 3);
  for (int i = 0; i < type.value_count(); ++i) {
    const auto proto = static_cast<Proto>(type.value(i)->number());
    EXPECT_EQ(static_cast<int>(FromProto<TypeParam>(proto)), type.value(i)->number()) << type.value(i)->name();
    EXPECT_EQ(ToProto(FromProto<TypeParam>(proto)), proto) << type.value(i)->name();
  }
}

TEST(EnumTest, RegimeOfAnUnknownNumberIsUnspecified) {
  EXPECT_EQ(FromProto<Regime>(static_cast<v1::Regime>(999)), Regime::kUnspecified);
  EXPECT_EQ(FromProto<Regime>(static_cast<v1::Regime>(-1)), Regime::kUnspecified);
  EXPECT_EQ(ToProto(static_cast<Regime>(999)), v1::REGIME_UNSPECIFIED);
}

TEST(EnumTest, EventKindOfAnUnknownNumberIsUnspecified) {
  EXPECT_EQ(FromProto<EventKind>(static_cast<v1::Event::Kind>(999)), EventKind::kUnspecified);
  EXPECT_EQ(ToProto(static_cast<EventKind>(999)), v1::Event::KIND_UNSPECIFIED);
}

TEST(EnumTest, LimitKindOfAnUnknownNumberIsUnspecified) {
  EXPECT_EQ(FromProto<LimitKind>(static_cast<v1::BrokenLimit::Kind>(999)), LimitKind::kUnspecified);
  EXPECT_EQ(ToProto(static_cast<LimitKind>(999)), v1::BrokenLimit::KIND_UNSPECIFIED);
}

TEST(EnumTest, AccuracyKindOfAnUnknownNumberIsUnspecified) {
  EXPECT_EQ(FromProto<AccuracyKind>(static_cast<v1::Accuracy::Kind>(999)), AccuracyKind::kUnspecified);
  EXPECT_EQ(ToProto(static_cast<AccuracyKind>(999)), v1::Accuracy::KIND_UNSPECIFIED);
}

TEST(EnumTest, VerdictOfAnUnknownNumberIsUnspecified) {
  EXPECT_EQ(FromProto<Verdict>(static_cast<v1::LimitCheck::Verdict>(999)), Verdict::kUnspecified);
  EXPECT_EQ(ToProto(static_cast<Verdict>(999)), v1::LimitCheck::VERDICT_UNSPECIFIED);
}

TEST(EnumTest, LimitsOfAnAuditHaveTheNumbersOfTheirFields) {
  const auto& limits = *v1::AuditLimits::descriptor();
  EXPECT_EQ(limits.field_count(), kAuditLimitCount - 1);
  EXPECT_EQ(limits.FindFieldByName("sharp")->number(), static_cast<int>(AuditLimit::kSharp));
  EXPECT_EQ(limits.FindFieldByName("energy")->number(), static_cast<int>(AuditLimit::kEnergy));
  EXPECT_EQ(limits.FindFieldByName("normal_impulse")->number(), static_cast<int>(AuditLimit::kNormalImpulse));
  EXPECT_EQ(limits.FindFieldByName("penetration")->number(), static_cast<int>(AuditLimit::kPenetration));
  EXPECT_EQ(limits.FindFieldByName("cone")->number(), static_cast<int>(AuditLimit::kCone));
}

TEST(EnumTest, CombinationOfAnUnknownNumberKeepsIt) {
  EXPECT_EQ(static_cast<int>(FromProto<Combination>(static_cast<v1::SweepRequest::Combination>(999))), 999);
  EXPECT_EQ(static_cast<int>(ToProto(static_cast<Combination>(999))), 999);
}

TEST(EnumTest, ProtoHasOneRegimeForEachTallyOfTheCore) {
  EXPECT_EQ(v1::Regime_descriptor()->value_count(), kRegimeCount);
}

}  // namespace
}  // namespace ricochet
