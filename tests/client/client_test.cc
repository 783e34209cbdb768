// Rules of the client itself: its options, its retries, a failing network, chunks that do not fit together.

#include "ricochet/client.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cost_reader.h"
#include "ricochet/health.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "tests/support/processes/server_process.h"

namespace ricochet {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

Scene AnyScene() {
  Scene scene;
  scene.system = Pendulum{.inertia_kg_m2 = 1.0, .a_m = 0.3, .b_m = 1.0, .omega_minus_rad_s = -1.0};
  scene.restitution = EnergeticCoefficient{1.0};
  return scene;
}

SweepRequest Sweep(int64_t points) {
  SweepRequest request;
  request.grid.scene = AnyScene();
  request.grid.axes = {{"friction.kinetic_coefficient", Linspace{0.0, 0.4, points}}};
  request.columns = {"coefficients.newton", "coefficients.poisson"};
  return request;
}

TEST(ClientOptions, AreRefusedAllAtOnceByName) {
  ClientOptions options{
      .target = "", .deadline = milliseconds(0), .sweep_deadline = milliseconds(-5), .max_receive_bytes = 0};
  options.retry = {.max_attempts = 6,
                   .max_resumes = -1,
                   .initial_backoff = milliseconds(0),
                   .max_backoff = milliseconds(-1),
                   .multiplier = 0.5};
  const absl::Status status = Client::Connect(options).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ReasonOf(status), ErrorReason::kInvalidRequest);
  EXPECT_THAT(ViolationsOf(status),
              ElementsAre(Violation{"target", "is empty: must be \"host:port\""},
                          Violation{"deadline", "= 0 ms: must be > 0 and at most a year"},
                          Violation{"sweep_deadline", "= -5 ms: must be > 0 and at most a year"},
                          Violation{"max_receive_bytes", "= 0: must be in [1, 2147483647]"},
                          Violation{"retry.max_attempts", "= 6: must be in [1, 5]"},
                          Violation{"retry.max_resumes", "= -1: must be >= 0"},
                          Violation{"retry.initial_backoff", "= 0 ms: must be > 0 and at most a year"},
                          Violation{"retry.max_backoff", "= -1 ms: must be >= retry.initial_backoff"},
                          Violation{"retry.multiplier", "= 0.5: must be finite and >= 1"}));
}

TEST(ClientOptionsTest, AUserAgentIsPrintable) {
  for (const std::string& agent : {std::string("x\ny"), std::string(1, '\0'), std::string(257, 'x')}) {
    const absl::Status status = Client::Connect({.target = "localhost:1", .user_agent = agent}).status();
    ASSERT_EQ(ViolationsOf(status).size(), 1U);
    EXPECT_EQ(ViolationsOf(status)[0].field, "user_agent");
  }
}

TEST(ServiceConfig, IsTheJsonThatGrpcReads) {
  ClientOptions options{.target = "localhost:1"};
  options.retry = {
      .max_attempts = 4, .initial_backoff = milliseconds(50), .max_backoff = milliseconds(1500), .multiplier = 1.5};
  const std::string config = ServiceConfig(options);
  EXPECT_EQ(config, R"({"methodConfig":[{"name":[{"service":"ricochet.v1.ImpactService","method":"Sweep"}]},)"
                    R"({"name":[{"service":"ricochet.v1.ImpactService"}],"retryPolicy":{"maxAttempts":4,)"
                    R"("initialBackoff":"0.050s","maxBackoff":"1.500s","backoffMultiplier":1.5,)"
                    R"("retryableStatusCodes":["UNAVAILABLE","CANCELLED"]}}],)"
                    R"("retryThrottling":{"maxTokens":10,"tokenRatio":0.1}})");
  google::protobuf::Struct parsed;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(config, &parsed).ok());
}

TEST(ClientOptions, OfAListNameAServerBetweenItsCommas) {
  EXPECT_THAT(ViolationsOf(Client::Connect({.target = "a:1,,b:2"}).status()),
              ElementsAre(Violation{"target", "= \"a:1,,b:2\": must name a server before and after each comma"}));
  EXPECT_THAT(Targets({.target = "a:1,b:2"}), ElementsAre("a:1", "b:2"));
}

TEST(ServiceConfig, OfOneAttemptHasNoPolicy) {
  ClientOptions options{.target = "localhost:1"};
  options.retry.max_attempts = 1;
  EXPECT_EQ(ServiceConfig(options), "{}");
}

TEST(Client, FailsAtTheFirstCallWhereNoServerIs) {
  const auto client = Client::Connect({.target = "127.0.0.1:1"});
  ASSERT_TRUE(client.ok());
  EXPECT_EQ(client->Solve({.scene = AnyScene(), .history_at_n_s = {}}).status().code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(client->Bounds({.scene = AnyScene()}).status().code(), absl::StatusCode::kUnavailable);
  std::vector<absl::StatusCode> codes;
  for (const auto& chunk : client->Sweep(Sweep(10))) codes.push_back(chunk.status().code());
  EXPECT_THAT(codes, ElementsAre(absl::StatusCode::kUnavailable));
}

// Counts the calls that it refuses in a way that may be tried again.
class BusyService final : public v1::ImpactService::Service {
 public:
  grpc::Status Solve(grpc::ServerContext* /*context*/, const v1::SolveRequest* /*request*/,
                     v1::SolveResponse* /*response*/) override {
    ++calls_;
    return {grpc::StatusCode::UNAVAILABLE, "busy"};
  }
  int calls() const { return calls_; }

 private:
  std::atomic<int> calls_ = 0;
};

// gRPC keeps one budget of retries for all channels to an address, so that each number has a server of its own.
TEST(Client, TriesAgainAsOftenAsTheOptionsSay) {
  for (const int attempts : {1, 2, 5}) {
    BusyService service;
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(&service);
    const std::unique_ptr<grpc::Server> server = builder.BuildAndStart();
    ClientOptions options{.target = "127.0.0.1:" + std::to_string(port)};
    options.retry = {.max_attempts = attempts, .initial_backoff = milliseconds(1)};
    EXPECT_EQ(Client::Connect(options)->Solve({.scene = AnyScene()}).status().code(), absl::StatusCode::kUnavailable);
    EXPECT_EQ(service.calls(), attempts);
  }
}

TEST(Client, TellsThatItsServerHasGone) {
  ServerProcess server;
  const Client client = Client::Connect({.target = server.address(), .retry = {.max_attempts = 1}}).value();
  EXPECT_TRUE(client.Solve({.scene = AnyScene(), .history_at_n_s = {}}).ok());
  EXPECT_EQ(server.Stop(), 0);
  EXPECT_EQ(client.Solve({.scene = AnyScene(), .history_at_n_s = {}}).status().code(), absl::StatusCode::kUnavailable);
}

TEST(Client, AnAnswerThatIsTooLargeNamesTheLimit) {
  const ServerProcess server;
  const SolveRequest request = {.scene = AnyScene(), .history_intervals = 1000};
  const auto solve = [&](int64_t most) {
    return Client::Connect({.target = server.address(), .max_receive_bytes = most}).value().Solve(request).status();
  };
  const absl::Status status = solve(20'000);
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(status.message(), HasSubstr(" vs. 20000)"));
  EXPECT_THAT(status.message(), HasSubstr("ClientOptions::max_receive_bytes (--max-receive)"));
  EXPECT_EQ(solve(200'000), absl::OkStatus());
}

// A batch is asked in pieces whose answers the client takes.
TEST(Client, ABatchIsAskedInPiecesThatItReceives) {
  const ServerProcess server;
  const Client client = Client::Connect({.target = server.address(), .max_receive_bytes = 100'000}).value();
  constexpr size_t kRows = 200'000;
  std::vector<double> friction(kRows), newton(kRows);
  for (size_t row = 0; row < kRows; ++row) friction[row] = 1e-6 * static_cast<double>(row);
  const BatchSetup setup = {
      .scene = AnyScene(), .fields = {"friction.kinetic_coefficient"}, .columns = {"coefficients.newton"}};
  const auto batch = client.SolveBatch(setup, {.inputs = {friction}, .outputs = {absl::MakeSpan(newton)}});
  ASSERT_TRUE(batch.ok()) << batch.status();
  std::vector<double> here(kRows);
  ASSERT_TRUE(LocalSolver().SolveBatch(setup, {.inputs = {friction}, .outputs = {absl::MakeSpan(here)}}).ok());
  EXPECT_TRUE(newton == here);
}

// A number of no loss is not taken for the default.
TEST(Client, AnUnknownLossIsRefused) {
  const ServerProcess server;
  const Client client = Client::Connect({.target = server.address()}).value();
  const FitRequest request = {.scene = AnyScene(),
                              .unknowns = {{.path = "friction.kinetic_coefficient"}},
                              .measured = {{"coefficients.newton", {0.5}, {0.1}}},
                              .loss = static_cast<FitLoss>(9)};
  const LocalSolver here;
  for (const Solver* const solver : {static_cast<const Solver*>(&client), static_cast<const Solver*>(&here)}) {
    const std::vector<Violation> violations = ViolationsOf(solver->Fit(request).status());
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0].field, "loss");
    EXPECT_THAT(violations[0].description, HasSubstr("= 9: must be"));
  }
}

// The largest answer that a server with its default limits gives, and the largest message that a client takes.
TEST(Client, TakesTheLongestHistory) {
  const ServerProcess server;
  const Client client = Client::Connect({.target = server.address()}).value();
  const auto answer = client.Solve({.scene = AnyScene(), .history_intervals = kMostIntervals});
  EXPECT_TRUE(answer.ok()) << answer.status();
}

TEST(Client, ABatchOfManyPiecesFailsWithTheServersOwnError) {
  const ServerProcess server;
  const Client client = Client::Connect({.target = server.address()}).value();
  const std::vector<double> frictions(1'000'000, 0.1);
  std::vector<double> column(frictions.size());
  std::vector<Regime> regimes(frictions.size());
  std::vector<RowStatus> statuses(frictions.size());
  BatchRows rows = {.inputs = {frictions}, .outputs = {absl::MakeSpan(column)}};
  rows.regimes = absl::MakeSpan(regimes);
  rows.statuses = absl::MakeSpan(statuses);
  const auto answer = client.SolveBatch(
      {.scene = AnyScene(), .fields = {"friction.kinetic_coefficient"}, .columns = {"coefficients.nwton"}}, rows);
  EXPECT_EQ(answer.status().code(), absl::StatusCode::kInvalidArgument) << answer.status();
  EXPECT_THAT(ViolationsOf(answer.status()), ElementsAre(testing::Field(&Violation::field, "columns[0]")));
}

TEST(Client, ADeadlineEndsASweep) {
  const ServerProcess server;
  const Client client = Client::Connect({.target = server.address(), .sweep_deadline = milliseconds(100)}).value();
  absl::Status last;
  for (const auto& chunk : client.Sweep(Sweep(10'000'000'000))) last = chunk.status();
  EXPECT_EQ(last.code(), absl::StatusCode::kDeadlineExceeded) << last;
}

TEST(Client, AStreamOutlivesTheClientThatMadeIt) {
  const ServerProcess server;
  std::optional<Client> client = Client::Connect({.target = server.address()}).value();
  SweepStream stream = client->Sweep(Sweep(500'000));
  client.reset();
  int64_t points = 0;
  for (const auto& chunk : stream) {
    ASSERT_TRUE(chunk.ok()) << chunk.status();
    points += chunk->count;
  }
  EXPECT_EQ(points, 500'000);
}

TEST(Client, AServerThatDiesInASweepIsAnErrorAndNeverAShortAnswer) {
  ServerProcess server;
  const Client client = Client::Connect({.target = server.address(), .retry = {.max_resumes = 1}}).value();
  absl::Status last;
  for (const auto& chunk : client.Sweep(Sweep(10'000'000'000))) {
    last = chunk.status();
    if (chunk.ok() && chunk->first_index == 0) kill(server.pid(), SIGKILL);
  }
  EXPECT_EQ(last.code(), absl::StatusCode::kUnavailable) << last;
}

TEST(CheckHealth, TellsServingFromUnknownServices) {
  const ServerProcess server;
  EXPECT_EQ(CheckHealth({.target = server.address()}, "ricochet.v1.ImpactService").value(), Health::kServing);
  EXPECT_EQ(CheckHealth({.target = server.address()}, "no.such.Service").status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(CheckHealth({.target = ""}, "").status().code(), absl::StatusCode::kInvalidArgument);
}

// The first two parts of a study of two rows, and the end.
CostChunk CostPart(int64_t first, int64_t count, bool last) {
  CostChunk chunk = {.first_row = first, .rows_done = first + count, .rows_total = 2};
  chunk.rows.resize(static_cast<size_t>(count));
  if (last) chunk.summary = CostSummary{.front = {1}, .picks = {CostPick{.row = -1}}};
  return chunk;
}

TEST(CostChecker, TakesAStudyInOrder) {
  CostChecker checker;
  EXPECT_TRUE(checker.Check(CostPart(0, 0, false)).ok());
  EXPECT_TRUE(checker.Check(CostPart(0, 1, false)).ok());
  EXPECT_EQ(checker.CheckEnd().code(), absl::StatusCode::kDataLoss);
  EXPECT_TRUE(checker.Check(CostPart(1, 1, true)).ok());
  EXPECT_TRUE(checker.CheckEnd().ok());
  EXPECT_EQ(checker.Check(CostPart(2, 0, true)).code(), absl::StatusCode::kDataLoss);
}

TEST(CostChecker, RefusesPartsThatDoNotFitTogether) {
  const auto refuses = [](const CostChunk& chunk) {
    return CostChecker().Check(chunk).code() == absl::StatusCode::kDataLoss;
  };
  EXPECT_TRUE(refuses(CostPart(1, 1, true)));   // A gap.
  EXPECT_TRUE(refuses(CostPart(0, 1, true)));   // A summary too early.
  EXPECT_TRUE(refuses(CostPart(0, 2, false)));  // No summary at the end.
  EXPECT_TRUE(refuses(CostPart(0, 3, true)));   // More rows than there are.
  CostChunk chunk = CostPart(0, 2, true);
  EXPECT_FALSE(refuses(chunk));
  chunk.summary->front = {2};
  EXPECT_TRUE(refuses(chunk));
  chunk = CostPart(0, 2, true);
  chunk.rows_done = 1;
  EXPECT_TRUE(refuses(chunk));
}

}  // namespace
}  // namespace ricochet
