// BoundedService: ricochet.v1.ImpactService as gRPC sees it, with bounds on what requests and answers hold in memory,
// and without requests that this server would understand in part only.
//
// The bytes of a request are read first, without keeping anything (proto/wire/message_content.h): one that holds more
// messages and texts than any request within the limits is refused with RESOURCE_EXHAUSTED and
// ErrorReason::kLimitExceeded, one with fields or enum values that this server does not know with INVALID_ARGUMENT, and
// is never parsed. Batches may have as many bytes as Limits::max_request_bytes, all other requests at most 1 MiB. What
// a request takes once it is parsed counts in the CallMemory until it is answered.

#ifndef RICOCHET_SERVER_CALLS_BOUNDED_SERVICE_H_
#define RICOCHET_SERVER_CALLS_BOUNDED_SERVICE_H_

#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>
#include <grpcpp/support/sync_stream.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "absl/status/statusor.h"
#include "ricochet/limits.h"
#include "ricochet/v1/impact_service.grpc.pb.h"
#include "server/admission/call_memory.h"
#include "server/admission/unread_watch.h"

namespace ricochet::server {

class Auth;

// The most bytes of a request that is no batch.
inline constexpr int64_t kMostBytes = int64_t{1} << 20;

// The bounds on one request: its bytes, and the messages and texts in it.
struct MessageBounds {
  int64_t bytes = 0;
  int64_t elements = 0;
};

// A request and the memory that it holds.
template <typename Request>
struct Parsed {
  CallMemory::Hold memory;
  Request message;
};

// RequestReader parses the requests of one call within their bounds. All references must outlive it.
class RequestReader {
 public:
  RequestReader(const grpc::ServerContext& context, const MessageBounds& bounds, CallMemory& memory, Auth* auth)
      : context_(context), bounds_(bounds), memory_(memory), auth_(auth) {}

  // Makes a request of its bytes, which are let go of.
  // Errors: those of CheckContent and CallMemory::Take, RESOURCE_EXHAUSTED with ErrorReason::kLimitExceeded for too
  // many bytes, and INVALID_ARGUMENT if the bytes are no such request.
  template <typename Request>
  absl::StatusOr<Parsed<Request>> Parse(grpc::ByteBuffer& bytes) const;

  // Takes memory for messages of so many bytes.
  absl::StatusOr<CallMemory::Hold> Take(int64_t bytes) const;

 private:
  const grpc::ServerContext& context_;
  const MessageBounds bounds_;
  CallMemory& memory_;
  Auth* auth_;
};

// BoundedBatches: a stream of batches. Each request is bounded by itself.
class BoundedBatches {
 public:
  using Stream = grpc::ServerReaderWriter<v1::SolveBatchResponse, grpc::ByteBuffer>;

  // The stream must outlive this object.
  BoundedBatches(Stream& stream, RequestReader reader) : stream_(stream), reader_(std::move(reader)) {}

  // Waits for the next request. Returns false if the caller sends no more or the call has ended.
  bool Receive() { return stream_.Read(&received_); }

  // The bytes of the request received.
  int64_t received_bytes() const { return static_cast<int64_t>(received_.Length()); }

  // Reads the request received. Errors: those of RequestReader::Parse.
  absl::StatusOr<Parsed<v1::SolveBatchRequest>> Parse();

  // Returns false if the call has ended.
  bool Write(const v1::SolveBatchResponse& response) { return stream_.Write(response); }

 private:
  Stream& stream_;
  const RequestReader reader_;
  grpc::ByteBuffer received_;
};

class BoundedService final : public grpc::Service {
 public:
  using Methods = v1::ImpactService::Service;
  using Batches = std::function<grpc::Status(grpc::ServerContext&, BoundedBatches&)>;

  // The calls share these, which must outlive the service.
  struct Frame {
    UnreadWatch& unread;   // Watches the answers.
    CallMemory& memory;    // Requests and streams take from it.
    Auth* auth = nullptr;  // Knows callers by token or certificate; null if the server has no such list.
  };

  // Passes every call on to `service`, and every stream of batches to `batches`, which must outlive this service.
  BoundedService(Methods& service, Batches batches, const Limits& limits, const Frame& frame);

 private:
  // Each `path` is that of a method, "/ricochet.v1.ImpactService/Solve", and is never freed.
  template <typename Request, typename Response>
  void AddUnary(const char* path, grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*, Response*));
  template <typename Request, typename Response>
  void AddStream(const char* path,
                 grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*, grpc::ServerWriter<Response>*));
  void AddBatches(const char* path);
  void Add(const char* path, grpc::internal::RpcMethod::RpcType type,
           std::unique_ptr<grpc::internal::MethodHandler> handler);
  // Returns what the handler of a refused call must return, and has the watch end the call soon if the caller does not
  // read it.
  grpc::Status Refuse(const grpc::ServerContext& context, const absl::Status& refusal) const;
  // Returns what reads the requests of a call.
  template <typename Request>
  RequestReader ReaderOf(const grpc::ServerContext& context) const;

  Methods& service_;
  const Batches batches_;
  const int64_t most_elements_;
  const int64_t most_batch_bytes_;
  const Frame frame_;
};

// The most messages and texts that a request may hold: at least 16,384, and more than any request within the limits
// has.
int64_t MostElements(const Limits& limits);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_CALLS_BOUNDED_SERVICE_H_
