// BoundedService: ricochet.v1.ImpactService as gRPC sees it, with a bound on what a request may unfold to in memory.
//
// A message of 1 MiB can hold half a million empty messages, each of which takes a hundred bytes once it is parsed. So
// the bytes of a large request are read first, without keeping anything: one that holds more messages, texts and unknown
// fields than any request within the limits is refused with RESOURCE_EXHAUSTED and ErrorReason::kLimitExceeded, and is
// never parsed. Requests that are too small to hold that many are parsed at once.

#ifndef RICOCHET_SERVER_BOUNDED_SERVICE_H_
#define RICOCHET_SERVER_BOUNDED_SERVICE_H_

#include <google/protobuf/descriptor.h>
#include <grpcpp/impl/service_type.h>

#include <cstdint>
#include <memory>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "ricochet/limits.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "server/unread_watch.h"

namespace ricochet::server {

class BoundedService final : public grpc::Service {
 public:
  using Methods = v1::ImpactService::Service;

  // Passes every call on to `service`. `unread` watches its answers. Both must outlive this service.
  BoundedService(Methods& service, const Limits& limits, UnreadWatch& unread);

 private:
  // Each `path` is that of a method, "/ricochet.v1.ImpactService/Solve", and is never freed.
  template <typename Request, typename Response>
  void AddUnary(const char* path, grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*, Response*));
  template <typename Request, typename Response>
  void AddStream(const char* path,
                 grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*, grpc::ServerWriter<Response>*));
  void Add(const char* path, bool is_stream, const google::protobuf::Descriptor& request,
           std::unique_ptr<grpc::internal::MethodHandler> handler);

  Methods& service_;
  const int64_t most_elements_;
  UnreadWatch& unread_;
};

// The most messages, texts and unknown fields that a request may hold: at least 16,384, and more than any request within
// the limits has.
int64_t MostElements(const Limits& limits);

// Counts the messages, texts and unknown fields that the bytes of a message of type `type` hold.
// Errors: RESOURCE_EXHAUSTED with ErrorReason::kLimitExceeded as soon as there are more than `most`. Bytes that are no
// message are left to the parser.
absl::Status CheckElements(absl::string_view bytes, const google::protobuf::Descriptor& type, int64_t most);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BOUNDED_SERVICE_H_
