// Tests who is let in, by every kind of evidence that a call can carry.

#include "server/security/auth.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "ricochet/v1/impact_service.pb.h"
#include "tests/support/processes/temporary_directory.h"

namespace ricochet::server {
namespace {

using absl::StatusCode;
using testing::HasSubstr;
using testing::Not;

// The output of: printf TOKEN | sha256sum, for "abc" and for 512 and 513 times the letter a.
constexpr char kAbc[] = "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr char k512[] = "sha256:471be6558b665e4f6dd49f1184814d1491b0315d466beea768c153cc5500c836";
constexpr char k513[] = "sha256:02425c0f5b0dabf3d2b9115f3f7723a02ad8bcfb1534a0d231614fd42b8188f6";
constexpr char kSolve[] = "/ricochet.v1.ImpactService/Solve";

class AuthTest : public testing::Test {
 protected:
  void Open(const std::string& lines) {
    std::ofstream(directory_ / "tokens") << lines;
    auto opened = Auth::Open(directory_ / "tokens", log_);
    ASSERT_TRUE(opened.ok()) << opened.status();
    auth_ = *std::move(opened);
  }
  StatusCode Check(const Evidence& evidence) { return auth_->Check(evidence).code(); }

  TemporaryDirectory directory_;
  std::ostringstream text_;
  Log log_{LogFormat::kText, LogLevel::kInfo, text_};
  std::shared_ptr<Auth> auth_;
};

TEST_F(AuthTest, ACallerMayCallWhatItsScopesNameAndNothingElse) {
  std::vector<std::string> methods = {"/grpc.reflection.v1.ServerReflection/ServerReflectionInfo"};
  const auto& service = *v1::SolveRequest::descriptor()->file()->service(0);
  for (int i = 0; i < service.method_count(); ++i) {
    methods.push_back("/" + std::string(service.full_name()) + "/" + std::string(service.method(i)->name()));
  }
  for (const std::string& scope : Scopes()) {
    Open(absl::StrCat("lab ", kAbc, " ", scope, "\nlab.test certificate ", scope));
    for (const std::string& method : methods) {
      const bool may = scope == "all" || ScopeOf(method) == scope;
      const StatusCode expected = may ? StatusCode::kOk : StatusCode::kPermissionDenied;
      EXPECT_EQ(Check({.method = method, .authorization = {"Bearer abc"}}), expected) << scope << " " << method;
      EXPECT_EQ(Check({.method = method, .certificate_names = {"lab.test"}}), expected) << scope << " " << method;
      EXPECT_EQ(Check({.method = method}), StatusCode::kUnauthenticated) << method;
    }
    EXPECT_EQ(Check({.method = "/ricochet.v1.ImpactService/Fly", .authorization = {"Bearer abc"}}),
              StatusCode::kPermissionDenied)
        << scope;
    EXPECT_EQ(Check({.method = "/grpc.health.v1.Health/Check"}), StatusCode::kOk);
    EXPECT_EQ(Check({.method = "/grpc.health.v1.Health/Watch"}), StatusCode::kOk);
  }
}

TEST_F(AuthTest, ScopesOfOneLineAddUpAndThoseOfAnotherDoNot) {
  Open(std::string("lab ") + kAbc + " info,audit\nother.test certificate solve");
  for (const auto& [name, expected] :
       {std::pair{"Info", StatusCode::kOk}, {"Audit", StatusCode::kOk}, {"Solve", StatusCode::kPermissionDenied}}) {
    EXPECT_EQ(Check({.method = std::string("/ricochet.v1.ImpactService/") + name, .authorization = {"Bearer abc"}}),
              expected)
        << name;
  }
}

TEST_F(AuthTest, AWrongTokenIsNotMadeGoodByACertificate) {
  Open(std::string("lab ") + kAbc + " all\nlab.test certificate all");
  for (const std::vector<std::string>& authorization : {std::vector<std::string>{"Bearer abd"},
                                                        {"Basic abc"},
                                                        {"abc"},
                                                        {""},
                                                        {"Bearer abc", "Bearer abc"},
                                                        {"Bearer "}}) {
    EXPECT_EQ(Check({.method = kSolve, .authorization = authorization, .certificate_names = {"lab.test"}}),
              StatusCode::kUnauthenticated)
        << authorization.front();
  }
  EXPECT_EQ(Check({.method = kSolve, .authorization = {"bearer abc"}}), StatusCode::kOk);
}

TEST_F(AuthTest, ACertificateCountsByAnyOfItsNames) {
  Open("lab.test certificate all");
  EXPECT_EQ(Check({.method = kSolve, .certificate_names = {"localhost", "lab.test"}}), StatusCode::kOk);
  EXPECT_EQ(Check({.method = kSolve, .certificate_names = {"localhost"}}), StatusCode::kUnauthenticated);
}

TEST_F(AuthTest, TokensAbove512BytesAreNotLookedAt) {
  Open(std::string("a ") + k512 + " all\nb " + k513 + " all");
  EXPECT_EQ(Check({.method = kSolve, .authorization = {"Bearer " + std::string(512, 'a')}}), StatusCode::kOk);
  EXPECT_EQ(Check({.method = kSolve, .authorization = {"Bearer " + std::string(513, 'a')}}),
            StatusCode::kUnauthenticated);
  EXPECT_THAT(text_.str(), HasSubstr("token too long"));
}

TEST_F(AuthTest, ARefusalTellsTheLogWhyAndTheCallerNothing) {
  Open(std::string("lab ") + kAbc + " info");
  std::vector<std::string> counted;
  auth_->OnRefusal([&counted](const std::string& reason) { counted.push_back(reason); });
  const absl::Status denied =
      auth_->Check({.method = kSolve, .authorization = {"Bearer abc"}, .user_agent = "agent", .request_id = "job-7"});
  EXPECT_EQ(denied.message(), "the caller may not call this method");
  // An identifier that the server makes up may hold any letters.
  EXPECT_EQ(Check({.method = kSolve, .request_id = "job-8"}), StatusCode::kUnauthenticated);
  EXPECT_THAT(counted, testing::ElementsAre("PERMISSION_DENIED", "UNAUTHENTICATED"));
  EXPECT_THAT(text_.str(),
              HasSubstr("method=/ricochet.v1.ImpactService/Solve status=PERMISSION_DENIED request_id=job-7"));
  EXPECT_THAT(text_.str(), HasSubstr("caller=token:lab"));
  EXPECT_THAT(text_.str(), HasSubstr("reason=\"scope solve is missing\""));
  EXPECT_THAT(text_.str(), Not(HasSubstr("abc")));
}

TEST_F(AuthTest, TheLogHasTheBeginningOfALongUserAgent) {
  Open(std::string("lab ") + kAbc + " all");
  Check({.method = kSolve, .user_agent = std::string(8000, 'x')});
  EXPECT_THAT(text_.str(), HasSubstr("user_agent=" + std::string(256, 'x') + "... "));
}

// Opening a pipe to which nobody writes would never end.
TEST_F(AuthTest, TheFileOfTokensIsARegularFile) {
  const std::string pipe = directory_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto opened = Auth::Open(pipe, log_);
  EXPECT_EQ(opened.status().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(opened.status().message()), HasSubstr("pipe is not a regular file"));
}

}  // namespace
}  // namespace ricochet::server
