// EchoService: a service with the calls and message sizes of the impact service but no computation, for comparison.

#ifndef RICOCHET_TESTS_BENCHMARK_ECHO_SERVICE_H_
#define RICOCHET_TESTS_BENCHMARK_ECHO_SERVICE_H_

#include <utility>

#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet::bench {

class EchoService final : public v1::ImpactService::Service {
 public:
  // `answer` is what a Solve of a scene gets.
  explicit EchoService(v1::SolveResponse answer = {}) : answer_(std::move(answer)) {}

  // An empty response to an empty request.
  grpc::Status Solve(grpc::ServerContext* context, const v1::SolveRequest* request,
                     v1::SolveResponse* response) override;

  // [first_index, end_index) in messages of the sizes that a sweep of as many columns has; the values never change.
  grpc::Status Sweep(grpc::ServerContext* context, const v1::SweepRequest* request,
                     grpc::ServerWriter<v1::SweepResponse>* writer) override;

 private:
  const v1::SolveResponse answer_;
};

}  // namespace ricochet::bench

#endif  // RICOCHET_TESTS_BENCHMARK_ECHO_SERVICE_H_
