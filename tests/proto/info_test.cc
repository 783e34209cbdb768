// Info names what it names as the protos do: every limit, and every system of a scene.

#include "proto/wire/info.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/solver.h"
#include "ricochet/v1/scene.pb.h"

namespace ricochet {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::OneofDescriptor;

std::vector<std::string> FieldsOf(const Descriptor& message) {
  std::vector<std::string> names;
  for (int i = 0; i < message.field_count(); ++i) names.push_back(message.field(i)->name());
  return names;
}

TEST(InfoTest, EveryLimitOfARequestIsAFieldOfTheProto) {
  std::vector<std::string> names;
  for (const NamedLimit& limit : kLimits) names.emplace_back(limit.name);
  EXPECT_EQ(FieldsOf(*v1::Limits::descriptor()), names);
}

TEST(InfoTest, EveryLimitOfAServerIsAFieldOfTheProto) {
  std::vector<std::string> names;
  for (const NamedServerLimit& limit : kServerLimits) names.emplace_back(limit.name);
  EXPECT_EQ(FieldsOf(*v1::ServerLimits::descriptor()), names);
}

TEST(InfoTest, SystemsHaveTheNamesOfTheirFields) {
  const OneofDescriptor& systems = *v1::Scene::descriptor()->FindOneofByName("system");
  std::vector<std::string> names;
  for (int i = 0; i < systems.field_count(); ++i) names.push_back(systems.field(i)->name());
  EXPECT_EQ(LocalSolver().Info()->systems, names);
}

TEST(InfoTest, ALimitThatDoesNotLimitIsUnset) {
  InfoResponse response = {.limits = Limits::None()};
  response.limits.max_axes = 3;
  const v1::InfoResponse proto = ToProto(response);
  EXPECT_EQ(proto.limits().max_axes(), 3);
  EXPECT_FALSE(proto.limits().has_max_links());
  EXPECT_EQ(FromProto(proto), response);
}

}  // namespace
}  // namespace ricochet
