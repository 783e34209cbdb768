#include "tests/benchmark/echo_service.h"

namespace ricochet::bench {

grpc::Status EchoService::Solve(grpc::ServerContext* /*context*/, const v1::SolveRequest* request,
                                v1::SolveResponse* response) {
  if (request->has_scene()) *response = answer_;
  return grpc::Status::OK;
}

grpc::Status EchoService::Sweep(grpc::ServerContext* /*context*/, const v1::SweepRequest* request,
                                grpc::ServerWriter<v1::SweepResponse>* writer) {
  constexpr int64_t kChunkPoints = (int64_t{512} << 10) / (8 * sizeof(double));
  v1::SweepResponse response;
  for (int64_t first = request->first_index(); first < request->end_index(); first += response.count()) {
    response.set_first_index(first);
    response.set_count(std::min(kChunkPoints, request->end_index() - first));
    response.mutable_values()->resize(static_cast<size_t>(response.count() * request->columns_size()) * sizeof(double),
                                      '?');
    if (!writer->Write(response)) return grpc::Status::CANCELLED;
  }
  return grpc::Status::OK;
}

}  // namespace ricochet::bench
