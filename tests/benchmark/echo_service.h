// EchoService: a service with the calls and message sizes of the impact service but no computation, for comparison.

#ifndef RICOCHET_TESTS_BENCHMARK_ECHO_SERVICE_H_
#define RICOCHET_TESTS_BENCHMARK_ECHO_SERVICE_H_

#include "ricochet/v1/impact_service.grpc.pb.h"

namespace ricochet::bench {

class EchoService final : public v1::ImpactService::Service {
 public:
  // An empty response.
  grpc::Status Solve(grpc::ServerContext* context, const v1::SolveRequest* request,
                     v1::SolveResponse* response) override;

  // [first_index, end_index) in messages of the sizes that a sweep of as many columns has; the values never change.
  grpc::Status Sweep(grpc::ServerContext* context, const v1::SweepRequest* request,
                     grpc::ServerWriter<v1::SweepResponse>* writer) override;
};

}  // namespace ricochet::bench

#endif  // RICOCHET_TESTS_BENCHMARK_ECHO_SERVICE_H_
