// The bytes of a request tell what it holds too much of, and what this version does not know.

#include "proto/wire/message_content.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "ricochet/error.h"
#include "ricochet/v1/impact_service.pb.h"

namespace ricochet {
namespace {

using testing::HasSubstr;

// The field with this number and these bytes.
std::string Field(int number, const std::string& bytes) {
  std::string field(1, static_cast<char>(number << 3 | 2));
  auto length = static_cast<uint32_t>(bytes.size());
  for (; length >= 0x80; length >>= 7) field += static_cast<char>(0x80 | (length & 0x7f));
  return field + static_cast<char>(length) + bytes;
}

absl::Status Check(const std::string& bytes, int64_t most = 10) {
  return CheckContent(bytes, *v1::SolveRequest::descriptor(), most).status();
}

TEST(CheckContent, CountsMessagesInMessages) {
  v1::SolveRequest request;
  for (int i = 0; i < 8; ++i) request.mutable_scene()->mutable_linkage()->add_links();
  EXPECT_TRUE(Check(request.SerializeAsString()).ok()) << "a scene, a linkage and eight links";
  request.mutable_scene()->mutable_linkage()->add_links();
  const absl::Status refused = Check(request.SerializeAsString());
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ReasonOf(refused), ErrorReason::kLimitExceeded);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("ricochet.v1.Linkage.links"));
}

TEST(CheckContent, CountsTexts) {
  v1::SweepRequest sweep;
  for (int i = 0; i < 11; ++i) sweep.add_columns();
  EXPECT_FALSE(CheckContent(sweep.SerializeAsString(), *v1::SweepRequest::descriptor(), 10).ok());
  EXPECT_EQ(CheckContent(sweep.SerializeAsString(), *v1::SweepRequest::descriptor(), 12).value(), 11);
}

TEST(CheckContent, DoesNotCountPackedNumbers) {
  v1::SolveRequest request;
  for (int i = 0; i < 1000; ++i) request.add_history_at_n_s(i);
  for (int i = 0; i < 1000; ++i) request.add_required(v1::EFFECT_FRICTION);
  EXPECT_TRUE(Check(request.SerializeAsString()).ok());
}

TEST(CheckContent, LeavesBytesThatAreNoMessageToTheParser) {
  EXPECT_TRUE(Check(Field(1, "\xff\xff\xff")).ok());
  EXPECT_TRUE(Check(std::string("\x0a\x7f\x00", 3)).ok()) << "cut off";
}

// The only violation of the bytes of a SolveRequest.
Violation Wrong(const std::string& bytes) {
  const absl::Status refused = Check(bytes);
  EXPECT_EQ(refused.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ViolationsOf(refused).size(), 1);
  return ViolationsOf(refused).empty() ? Violation() : ViolationsOf(refused)[0];
}

TEST(CheckContent, NamesAFieldThatIsUnknown) {
  for (const std::string& unknown : {std::string("\xf8\x07\x00", 3), std::string("\xfa\x07\x00", 3),
                                     std::string("\xfb\x07\xfc\x07", 4)}) {  // Field 127 of three wire types.
    const std::string linkage =
        Field(v1::Linkage::kLinksFieldNumber, "") + Field(v1::Linkage::kLinksFieldNumber, unknown);
    const Violation wrong =
        Wrong(Field(v1::SolveRequest::kSceneFieldNumber, Field(v1::Scene::kLinkageFieldNumber, linkage)));
    EXPECT_EQ(wrong.field, "scene.linkage.links[1]");
    EXPECT_THAT(wrong.description, HasSubstr("has a field of number 127 that the ricochet.v1.Link "));
    EXPECT_EQ(Wrong(unknown).field, "request");
  }
}

TEST(CheckContent, GoesNoDeeperThanTheTypesOfMessages) {
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep = Field(1, deep);
  EXPECT_EQ(Wrong(deep).field, "scene.pendulum");
}

// The parser would put a number of another wire type aside like an unknown field.
TEST(CheckContent, NamesAFieldOfAnotherWireType) {
  const std::string friction(1, static_cast<char>(v1::Friction::kKineticCoefficientFieldNumber << 3));
  const Violation wrong =
      Wrong(Field(v1::SolveRequest::kSceneFieldNumber, Field(v1::Scene::kFrictionFieldNumber, friction + "\x01")));
  EXPECT_EQ(wrong.field, "scene.friction");
  EXPECT_THAT(wrong.description, HasSubstr("has a field of number 1 "));
}

TEST(CheckContent, NamesAnEnumOfAnUnknownValue) {
  v1::SolveRequest request;
  request.add_required(v1::EFFECT_FRICTION);
  EXPECT_TRUE(Check(request.SerializeAsString()).ok());
  request.add_required(static_cast<v1::Effect>(99));
  EXPECT_EQ(Wrong(request.SerializeAsString()).field, "required");
  EXPECT_EQ(Wrong(request.SerializeAsString()).description, "= 99: must be a number of ricochet.v1.Effect");
  const std::string unpacked = {static_cast<char>(v1::SolveRequest::kRequiredFieldNumber << 3), 99};
  EXPECT_EQ(Wrong(unpacked).field, "required");
}

}  // namespace
}  // namespace ricochet
