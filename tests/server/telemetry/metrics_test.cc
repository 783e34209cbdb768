// Tests the numbers that calls leave in the metrics, as Prometheus reads them.

#include "server/telemetry/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace ricochet::server {
namespace {

using testing::HasSubstr;
using testing::Not;

CallRecord Solved() {
  CallRecord call;
  call.method = "Solve";
  call.status = absl::StatusCode::kOk;
  call.duration_s = 0.0007;
  call.received_bytes = 100;
  call.sent_bytes = 3000;
  call.solved_by_model.at(static_cast<size_t>(Model::kPendulum)) = 1;
  return call;
}

TEST(Metrics, ACallIsCountedUnderTheNamesAndInTheBucketsOfGrpc) {
  Metrics metrics;
  metrics.Started("Solve");
  metrics.Ended(Solved());
  const std::string text = metrics.Text();
  const std::string labels = R"({grpc_method="ricochet.v1.ImpactService/Solve",grpc_status="OK",le=)";
  EXPECT_THAT(text, HasSubstr(R"(grpc_server_call_started_total{grpc_method="ricochet.v1.ImpactService/Solve"} 1)"));
  EXPECT_THAT(text, HasSubstr("grpc_server_call_duration_seconds_bucket" + labels + "\"0.0003\"} 0"));
  EXPECT_THAT(text, HasSubstr("grpc_server_call_duration_seconds_bucket" + labels + "\"0.0008\"} 1"));
  EXPECT_THAT(text,
              HasSubstr("grpc_server_call_rcvd_total_compressed_message_size_bytes_bucket" + labels + "\"1024\"} 1"));
  EXPECT_THAT(text,
              HasSubstr("grpc_server_call_sent_total_compressed_message_size_bytes_bucket" + labels + "\"2048\"} 0"));
  EXPECT_THAT(text,
              HasSubstr("grpc_server_call_sent_total_compressed_message_size_bytes_bucket" + labels + "\"4096\"} 1"));
  EXPECT_THAT(text, HasSubstr(R"(ricochet_solved_total{model="pendulum"} 1)"));
}

TEST(Metrics, ASweepThatIsResumedCountsItsWork) {
  Metrics metrics;
  CallRecord call;
  call.method = "Sweep";
  call.points = 1000;
  call.first_index = 7;
  call.chunks = 3;
  call.chunk_bytes = 8000;
  call.stalls = 2;
  metrics.Ended(call);
  for (const char* line :
       {"ricochet_points_total 1000\n", "ricochet_chunks_total 3\n", "ricochet_chunk_bytes_total 8000\n",
        "ricochet_stalls_total 2\n", "ricochet_resumes_total 1\n"}) {
    EXPECT_THAT(metrics.Text(), HasSubstr(line));
  }
}

TEST(Metrics, TextOfCallersIsNeverALabel) {
  Metrics metrics;
  metrics.Started("Solve\"} evil");
  CallRecord call = Solved();
  call.method = "Nonsense";
  call.reason = "MADE_UP";
  metrics.Ended(call);
  call.reason = "TOO_MANY_CALLS";
  metrics.Ended(call);
  const std::string text = metrics.Text();
  EXPECT_THAT(text, HasSubstr(R"(grpc_server_call_started_total{grpc_method="other"} 1)"));
  EXPECT_THAT(text, HasSubstr(R"(ricochet_refusals_total{reason="OTHER"} 1)"));
  EXPECT_THAT(text, HasSubstr(R"(ricochet_refusals_total{reason="TOO_MANY_CALLS"} 1)"));
  EXPECT_THAT(text, Not(HasSubstr("evil")));
  EXPECT_THAT(text, Not(HasSubstr("Nonsense")));
  EXPECT_THAT(text, Not(HasSubstr("MADE_UP")));
}

TEST(Metrics, EveryReasonAndModelHasASeriesFromTheStart) {
  Metrics metrics;
  EXPECT_THAT(metrics.Text(), HasSubstr("ricochet_refusals_total{reason=\"UNREAD_LIMIT\"} 0\n"));
  EXPECT_THAT(metrics.Text(), HasSubstr("ricochet_solved_total{model=\"impact_law\"} 0\n"));
  EXPECT_THAT(metrics.Text(), Not(HasSubstr("unspecified")));
  metrics.Refused("UNAUTHENTICATED");
  EXPECT_THAT(metrics.Text(), HasSubstr("ricochet_refusals_total{reason=\"UNAUTHENTICATED\"} 1\n"));
}

TEST(Metrics, AGaugeIsAskedAtEachScrape) {
  Metrics metrics;
  double held = 1.0;
  metrics.AddGauge("held", "What is held.", [&held] { return held; });
  EXPECT_THAT(metrics.Text(), HasSubstr("# TYPE held gauge\nheld 1\n"));
  held = 2.0;
  EXPECT_THAT(metrics.Text(), HasSubstr("held 2\n"));
}

}  // namespace
}  // namespace ricochet::server
