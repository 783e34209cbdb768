#include "server/calls/bounded_service.h"

#include <grpc/byte_buffer.h>
#include <grpc/byte_buffer_reader.h>
#include <grpc/slice.h>
#include <grpcpp/support/method_handler.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/wire/message_content.h"
#include "proto/wire/status.h"
#include "ricochet/error.h"

namespace ricochet::server {
namespace {

using google::protobuf::Descriptor;

constexpr int64_t kLeastElements = 16'384;

absl::Status CheckBytes(int64_t bytes, int64_t most) {
  if (bytes <= most) return absl::OkStatus();
  return MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kLimitExceeded,
                   absl::StrCat("the request has ", bytes, " bytes: must have at most ", most,
                                most == kMostBytes ? "" : ", the limit max_request_bytes; send a batch in pieces"));
}

// Lets another handler parse and answer a request, unless it holds too much or what this server does not know.
class BoundedHandler final : public grpc::internal::MethodHandler {
 public:
  BoundedHandler(std::unique_ptr<grpc::internal::MethodHandler> handler, const Descriptor& request,
                 const MessageBounds& bounds, UnreadWatch& unread)
      : handler_(std::move(handler)), request_(request), bounds_(bounds), unread_(unread) {}

  // Returns when the answer is sent.
  void RunHandler(const HandlerParameter& parameter) override {
    const UnreadWatch::Answer answer(unread_, *static_cast<grpc::ServerContext*>(parameter.server_context));
    handler_->RunHandler(parameter);
  }

  void* Deserialize(grpc_call* call, grpc_byte_buffer* bytes, grpc::Status* status, void** data) override {
    const absl::Status checked = Check(bytes);
    if (checked.ok()) return handler_->Deserialize(call, bytes, status, data);
    grpc_byte_buffer_destroy(bytes);
    *status = ToGrpcStatus(checked);
    return nullptr;
  }

 private:
  absl::Status Check(grpc_byte_buffer* bytes) const {
    if (bytes == nullptr) return absl::OkStatus();
    const auto length = static_cast<int64_t>(grpc_byte_buffer_length(bytes));
    if (absl::Status too_long = CheckBytes(length, bounds_.bytes); !too_long.ok()) return too_long;
    grpc_byte_buffer_reader reader;
    if (grpc_byte_buffer_reader_init(&reader, bytes) == 0) return absl::OkStatus();
    const grpc_slice whole = grpc_byte_buffer_reader_readall(&reader);
    const absl::string_view view(reinterpret_cast<const char*>(GRPC_SLICE_START_PTR(whole)), GRPC_SLICE_LENGTH(whole));
    absl::Status checked = CheckContent(view, request_, bounds_.elements);
    grpc_slice_unref(whole);
    grpc_byte_buffer_reader_destroy(&reader);
    return checked;
  }

  const std::unique_ptr<grpc::internal::MethodHandler> handler_;
  const Descriptor& request_;
  const MessageBounds bounds_;
  UnreadWatch& unread_;
};

}  // namespace

int64_t MostElements(const Limits& limits) {
  // A link, a range, an axis or a column has at most four elements.
  const int64_t lists = limits.max_links + limits.max_ranges + limits.max_axes + limits.max_columns;
  return std::max(kLeastElements, 4 * lists + 64);
}

absl::Status CheckMessage(const grpc::ByteBuffer& bytes, const Descriptor& type, const MessageBounds& bounds) {
  const auto length = static_cast<int64_t>(bytes.Length());
  if (absl::Status too_long = CheckBytes(length, bounds.bytes); !too_long.ok()) return too_long;
  grpc::Slice whole;
  if (!bytes.DumpToSingleSlice(&whole).ok()) return absl::OkStatus();
  return CheckContent({reinterpret_cast<const char*>(whole.begin()), whole.size()}, type, bounds.elements);
}

absl::Status BoundedBatches::Parse(v1::SolveBatchRequest& request) {
  if (absl::Status refused = CheckMessage(received_, *v1::SolveBatchRequest::descriptor(), bounds_); !refused.ok()) {
    return refused;
  }
  const grpc::Status parsed = grpc::SerializationTraits<v1::SolveBatchRequest>::Deserialize(&received_, &request);
  if (parsed.ok()) return absl::OkStatus();
  return MakeError(absl::StatusCode::kInvalidArgument, ErrorReason::kInvalidRequest,
                   "the bytes of the request are not a message of the type that this method takes");
}

BoundedService::BoundedService(Methods& service, Batches batches, const Limits& limits, UnreadWatch& unread)
    : service_(service),
      batches_(std::move(batches)),
      most_elements_(MostElements(limits)),
      most_batch_bytes_(limits.max_request_bytes),
      unread_(unread) {
  AddUnary("/ricochet.v1.ImpactService/Solve", &Methods::Solve);
  AddUnary("/ricochet.v1.ImpactService/Bounds", &Methods::Bounds);
  AddStream("/ricochet.v1.ImpactService/Sweep", &Methods::Sweep);
  AddUnary("/ricochet.v1.ImpactService/Audit", &Methods::Audit);
  AddUnary("/ricochet.v1.ImpactService/AuditBatch", &Methods::AuditBatch);
  AddUnary("/ricochet.v1.ImpactService/Plan", &Methods::Plan);
  AddStream("/ricochet.v1.ImpactService/Cost", &Methods::Cost);
  AddUnary("/ricochet.v1.ImpactService/SolveBatch", &Methods::SolveBatch);
  AddBatches("/ricochet.v1.ImpactService/SolveBatches");
  AddUnary("/ricochet.v1.ImpactService/MultiContact", &Methods::MultiContact);
  AddUnary("/ricochet.v1.ImpactService/Fit", &Methods::Fit);
  AddUnary("/ricochet.v1.ImpactService/Info", &Methods::Info);
}

template <typename Request, typename Response>
void BoundedService::AddUnary(const char* path,
                              grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*, Response*)) {
  const auto run = [method](Methods* service, grpc::ServerContext* context, const Request* request,
                            Response* response) { return (service->*method)(context, request, response); };
  Add(path, grpc::internal::RpcMethod::NORMAL_RPC, *Request::descriptor(),
      std::make_unique<grpc::internal::RpcMethodHandler<Methods, Request, Response>>(run, &service_));
}

template <typename Request, typename Response>
void BoundedService::AddStream(const char* path, grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*,
                                                                                 grpc::ServerWriter<Response>*)) {
  const auto run = [method](Methods* service, grpc::ServerContext* context, const Request* request,
                            grpc::ServerWriter<Response>* writer) {
    return (service->*method)(context, request, writer);
  };
  Add(path, grpc::internal::RpcMethod::SERVER_STREAMING, *Request::descriptor(),
      std::make_unique<grpc::internal::ServerStreamingHandler<Methods, Request, Response>>(run, &service_));
}

void BoundedService::AddBatches(const char* path) {
  const auto run = [this](grpc::ServerContext* context, BoundedBatches::Stream* stream) {
    BoundedBatches batches(*stream, {.bytes = most_batch_bytes_, .elements = most_elements_});
    return batches_(*context, batches);
  };
  Add(path, grpc::internal::RpcMethod::BIDI_STREAMING, *v1::SolveBatchRequest::descriptor(),
      std::make_unique<grpc::internal::TemplatedBidiStreamingHandler<BoundedBatches::Stream, false>>(run));
}

void BoundedService::Add(const char* path, grpc::internal::RpcMethod::RpcType type, const Descriptor& request,
                         std::unique_ptr<grpc::internal::MethodHandler> handler) {
  const bool is_batch = &request == v1::SolveBatchRequest::descriptor();
  const MessageBounds bounds = {.bytes = is_batch ? most_batch_bytes_ : std::min(kMostBytes, most_batch_bytes_),
                                .elements = most_elements_};
  // The service owns the method, and the method owns the handler.
  AddMethod(new grpc::internal::RpcServiceMethod(path, type,
                                                 new BoundedHandler(std::move(handler), request, bounds, unread_)));
}

}  // namespace ricochet::server
