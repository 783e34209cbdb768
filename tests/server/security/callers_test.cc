#include "server/security/callers.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "absl/strings/ascii.h"
#include "ricochet/v1/impact_service.pb.h"

namespace ricochet::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// The output of: printf abc | sha256sum.
constexpr char kHashOfAbc[] = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(Callers, AreKnownByTheHashOfTheirToken) {
  const auto callers = Callers::Parse("# a comment\n\n  lab\tsha256:" + std::string(kHashOfAbc) + "  solve,sweep\r\n");
  ASSERT_TRUE(callers.ok()) << callers.status();
  const auto caller = callers->WithToken("abc");
  ASSERT_TRUE(caller.has_value());
  EXPECT_EQ(caller->name, "token:lab");
  EXPECT_THAT(caller->scopes, ElementsAre("solve", "sweep"));
  EXPECT_FALSE(callers->WithToken("abd").has_value());
  EXPECT_FALSE(callers->WithToken("").has_value());
  EXPECT_FALSE(callers->WithToken(kHashOfAbc).has_value());
  EXPECT_FALSE(callers->WithCertificate("lab").has_value());
}

TEST(Callers, EveryByteOfTheHashCounts) {
  for (size_t i = 0; i < 64; ++i) {
    std::string hash = kHashOfAbc;
    hash[i] = hash[i] == '0' ? '1' : '0';
    const auto callers = Callers::Parse("lab sha256:" + hash + " all");
    ASSERT_TRUE(callers.ok()) << callers.status();
    EXPECT_FALSE(callers->WithToken("abc").has_value()) << i;
  }
}

TEST(Callers, EveryScopeOfALineMustBeKnown) {
  for (const std::string scopes : {"solve,speed", "speed,solve", "all,", ",all", "Solve"}) {
    EXPECT_FALSE(Callers::Parse("lab certificate " + scopes).ok()) << scopes;
  }
}

TEST(Callers, AreKnownByTheNameOfTheirCertificate) {
  const auto callers = Callers::Parse("lab.example certificate all");
  ASSERT_TRUE(callers.ok()) << callers.status();
  const auto caller = callers->WithCertificate("lab.example");
  ASSERT_TRUE(caller.has_value());
  EXPECT_EQ(caller->name, "certificate:lab.example");
  EXPECT_FALSE(callers->WithCertificate("lab.example.org").has_value());
}

TEST(Callers, EveryWrongLineIsNamedByItsNumberOnly) {
  const std::string hash = kHashOfAbc;
  const auto callers =
      Callers::Parse("a sha256:" + hash + " solve\nb secret solve\nc sha256:" + hash +
                     " speed\nd sha256:" + hash.substr(1) + " solve\ne certificate\nf md5:" + hash + " all\n");
  EXPECT_EQ(callers.status().code(), absl::StatusCode::kInvalidArgument);
  const std::string message(callers.status().message());
  for (const int line : {2, 3, 4, 5, 6})
    EXPECT_THAT(message, HasSubstr("line " + std::to_string(line) + " must be NAME"));
  EXPECT_THAT(message, Not(HasSubstr("line 1 ")));
  EXPECT_THAT(message, Not(HasSubstr("secret")));
}

TEST(Callers, NoTwoLinesHaveOneTokenOrOneCertificate) {
  const std::string hash = kHashOfAbc;
  const auto callers =
      Callers::Parse("a sha256:" + hash + " solve\nlab certificate info\nb sha256:" + absl::AsciiStrToUpper(hash) +
                     " info\nlab certificate solve\n");
  EXPECT_EQ(callers.status().message(),
            "line 3 must have another token than line 1; line 4 must have another certificate than line 2");
  EXPECT_TRUE(Callers::Parse("a sha256:" + hash + " solve\na certificate solve\n").ok());
}

TEST(Callers, FileWithoutCallersIsRefused) {
  EXPECT_EQ(Callers::Parse("# nobody\n").status().message(), "no line names a caller");
}

TEST(Scopes, EveryMethodOfTheServiceHasTheOneThatTheReadmeStates) {
  // The table under "Tokens" in deploy/README.md.
  const std::map<std::string, std::string> stated = {
      {"Solve", "solve"},      {"SolveBatch", "solve"},   {"SolveBatches", "solve"}, {"Plan", "solve"},
      {"Bounds", "solve"},     {"Sweep", "sweep"},        {"Cost", "cost"},          {"Audit", "audit"},
      {"AuditBatch", "audit"}, {"MultiContact", "solve"}, {"Info", "info"},          {"Fit", "audit"}};
  const auto* const file = v1::SolveRequest::descriptor()->file();
  ASSERT_EQ(file->service_count(), 1);
  const auto& service = *file->service(0);
  for (int i = 0; i < service.method_count(); ++i) {
    const std::string name(service.method(i)->name());
    ASSERT_TRUE(stated.contains(name)) << name;
    EXPECT_EQ(ScopeOf("/" + std::string(service.full_name()) + "/" + name), stated.at(name)) << name;
  }
  EXPECT_EQ(ScopeOf("/grpc.reflection.v1.ServerReflection/ServerReflectionInfo"), "info");
  EXPECT_THAT(Scopes(), ElementsAre("audit", "cost", "info", "solve", "sweep", "all"));
}

TEST(Scopes, UnknownMethodsHaveNone) {
  EXPECT_EQ(ScopeOf("/grpc.health.v1.Health/Check"), "");
  EXPECT_EQ(ScopeOf("/ricochet.v1.ImpactService/"), std::nullopt);
  EXPECT_EQ(ScopeOf("/ricochet.v1.ImpactService/Fly"), std::nullopt);
  EXPECT_EQ(ScopeOf("/ricochet.v2.ImpactService/Solve"), std::nullopt);
  EXPECT_EQ(ScopeOf("Solve"), std::nullopt);
  EXPECT_EQ(ScopeOf(""), std::nullopt);
}

}  // namespace
}  // namespace ricochet::server
