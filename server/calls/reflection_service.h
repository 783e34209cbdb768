// ReflectionService: version 1 of gRPC's reflection protocol, which gRPC 1.51 lacks. It describes the proto files that
// are linked into this program.

#ifndef RICOCHET_SERVER_CALLS_REFLECTION_SERVICE_H_
#define RICOCHET_SERVER_CALLS_REFLECTION_SERVICE_H_

#include <string>
#include <utility>
#include <vector>

#include "grpc/reflection/v1/reflection.grpc.pb.h"

namespace ricochet::server {

class ReflectionService final : public grpc::reflection::v1::ServerReflection::Service {
 public:
  using Request = grpc::reflection::v1::ServerReflectionRequest;
  using Response = grpc::reflection::v1::ServerReflectionResponse;

  // `services`: the full names of the services to list.
  explicit ReflectionService(std::vector<std::string> services) : services_(std::move(services)) {}

  // Returns the answer to one question: an ErrorResponse with NOT_FOUND for an unknown file, symbol, extension or
  // message, and with INVALID_ARGUMENT for a request without a question.
  Response Answer(const Request& request) const;

  grpc::Status ServerReflectionInfo(grpc::ServerContext* context,
                                    grpc::ServerReaderWriter<Response, Request>* stream) override;

 private:
  const std::vector<std::string> services_;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALLS_REFLECTION_SERVICE_H_
