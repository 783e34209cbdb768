#include "server/calls/bounded_service.h"

#include <google/protobuf/descriptor.h>
#include <grpcpp/support/method_handler.h>
#include <grpcpp/support/slice.h>

#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/wire/message_content.h"
#include "proto/wire/status.h"
#include "ricochet/error.h"
#include "server/security/peer.h"

namespace ricochet::server {
namespace {

constexpr int64_t kLeastElements = 16'384;

// An empty message or text takes about this much memory once it is parsed and converted.
constexpr int64_t kBytesPerElement = 512;

// While its caller does not read, a stream holds a chunk of up to 512 KiB three times, as numbers, as a message and as
// the bytes of the message, and the chunk that follows it.
constexpr int64_t kStreamBytes = int64_t{2} << 20;

absl::Status CheckBytes(int64_t bytes, int64_t most) {
  if (bytes <= most) return absl::OkStatus();
  return MakeError(absl::StatusCode::kResourceExhausted, ErrorReason::kLimitExceeded,
                   absl::StrCat("the request has ", bytes, " bytes: must have at most ", most,
                                most == kMostBytes ? "" : ", the limit max_request_bytes; send a batch in pieces"));
}

// Returns the number of messages and texts; 0 for bytes that are no message. Errors: those of CheckContent.
absl::StatusOr<int64_t> CountElements(const grpc::ByteBuffer& bytes, const google::protobuf::Descriptor& type,
                                      int64_t most) {
  grpc::Slice whole;
  if (!bytes.DumpToSingleSlice(&whole).ok()) return 0;
  return CheckContent({reinterpret_cast<const char*>(whole.begin()), whole.size()}, type, most);
}

// Lets another handler answer a call, and watches whether the caller reads the answer.
class WatchedHandler final : public grpc::internal::MethodHandler {
 public:
  WatchedHandler(std::unique_ptr<grpc::internal::MethodHandler> handler, UnreadWatch& unread)
      : handler_(std::move(handler)), unread_(unread) {}

  // Returns when the answer is sent.
  void RunHandler(const HandlerParameter& parameter) override {
    const UnreadWatch::Answer answer(unread_, *static_cast<grpc::ServerContext*>(parameter.server_context));
    handler_->RunHandler(parameter);
  }

  void* Deserialize(grpc_call* call, grpc_byte_buffer* bytes, grpc::Status* status, void** data) override {
    return handler_->Deserialize(call, bytes, status, data);
  }

 private:
  const std::unique_ptr<grpc::internal::MethodHandler> handler_;
  UnreadWatch& unread_;
};

// The bytes of a call's only request. gRPC passes them as const, but they are the handler's, which lets go of them once
// they are parsed.
grpc::ByteBuffer& OwnedBytes(const grpc::ByteBuffer* bytes) { return const_cast<grpc::ByteBuffer&>(*bytes); }

}  // namespace

int64_t MostElements(const Limits& limits) {
  // A link, a range, an axis or a column has at most four elements.
  const int64_t lists = limits.max_links + limits.max_ranges + limits.max_axes + limits.max_columns;
  return std::max(kLeastElements, 4 * lists + limits.max_contact_states + 64);
}

template <typename Request>
absl::StatusOr<Parsed<Request>> RequestReader::Parse(grpc::ByteBuffer& bytes) const {
  const auto length = static_cast<int64_t>(bytes.Length());
  if (absl::Status too_long = CheckBytes(length, bounds_.bytes); !too_long.ok()) return too_long;
  const absl::StatusOr<int64_t> elements = CountElements(bytes, *Request::descriptor(), bounds_.elements);
  if (!elements.ok()) return elements.status();
  // The solver gets a copy of the request, except of the columns of a batch.
  absl::StatusOr<CallMemory::Hold> memory = Take(length + std::min(length, kMostBytes) + kBytesPerElement * *elements);
  if (!memory.ok()) return memory.status();
  absl::StatusOr<Parsed<Request>> parsed(absl::in_place, Parsed<Request>{*std::move(memory), Request()});
  if (grpc::SerializationTraits<Request>::Deserialize(&bytes, &parsed->message).ok()) return parsed;
  return MakeError(absl::StatusCode::kInvalidArgument, ErrorReason::kInvalidRequest,
                   "the bytes of the request are not a message of the type that this method takes");
}

absl::StatusOr<CallMemory::Hold> RequestReader::Take(int64_t bytes) const {
  return memory_.Take([this] { return PeerKey(context_, auth_); }, bytes);
}

absl::StatusOr<Parsed<v1::SolveBatchRequest>> BoundedBatches::Parse() {
  return reader_.Parse<v1::SolveBatchRequest>(received_);
}

BoundedService::BoundedService(Methods& service, Batches batches, const Limits& limits, const Frame& frame)
    : service_(service),
      batches_(std::move(batches)),
      most_elements_(MostElements(limits)),
      most_batch_bytes_(limits.max_request_bytes),
      frame_(frame) {
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

template <typename Request>
RequestReader BoundedService::ReaderOf(const grpc::ServerContext& context) const {
  constexpr bool kIsBatch = std::is_same_v<Request, v1::SolveBatchRequest>;
  const int64_t most = kIsBatch ? most_batch_bytes_ : std::min(kMostBytes, most_batch_bytes_);
  return {context, {.bytes = most, .elements = most_elements_}, frame_.memory, frame_.auth};
}

template <typename Request, typename Response>
void BoundedService::AddUnary(const char* path,
                              grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*, Response*)) {
  // gRPC gets the bytes of the answer and not the message, because it keeps what it gets until the caller has read it,
  // and a message can take many times as much memory as its bytes.
  const auto run = [this, method](Methods* service, grpc::ServerContext* context, const grpc::ByteBuffer* bytes,
                                  grpc::ByteBuffer* sent) {
    const absl::StatusOr<Parsed<Request>> request =
        ReaderOf<Request>(*context).template Parse<Request>(OwnedBytes(bytes));
    if (!request.ok()) return Refuse(*context, request.status());
    Response response;
    const grpc::Status status = (service->*method)(context, &request->message, &response);
    bool is_owned = false;
    return status.ok() ? grpc::SerializationTraits<Response>::Serialize(response, sent, &is_owned) : status;
  };
  Add(path, grpc::internal::RpcMethod::NORMAL_RPC,
      std::make_unique<grpc::internal::RpcMethodHandler<Methods, grpc::ByteBuffer, grpc::ByteBuffer>>(run, &service_));
}

template <typename Request, typename Response>
void BoundedService::AddStream(const char* path, grpc::Status (Methods::*method)(grpc::ServerContext*, const Request*,
                                                                                 grpc::ServerWriter<Response>*)) {
  const auto run = [this, method](Methods* service, grpc::ServerContext* context, const grpc::ByteBuffer* bytes,
                                  grpc::ServerWriter<Response>* writer) {
    const RequestReader reader = ReaderOf<Request>(*context);
    const absl::StatusOr<Parsed<Request>> request = reader.template Parse<Request>(OwnedBytes(bytes));
    if (!request.ok()) return Refuse(*context, request.status());
    const absl::StatusOr<CallMemory::Hold> chunks = reader.Take(kStreamBytes);
    if (!chunks.ok()) return Refuse(*context, chunks.status());
    return (service->*method)(context, &request->message, writer);
  };
  Add(path, grpc::internal::RpcMethod::SERVER_STREAMING,
      std::make_unique<grpc::internal::ServerStreamingHandler<Methods, grpc::ByteBuffer, Response>>(run, &service_));
}

void BoundedService::AddBatches(const char* path) {
  const auto run = [this](grpc::ServerContext* context, BoundedBatches::Stream* stream) {
    BoundedBatches batches(*stream, ReaderOf<v1::SolveBatchRequest>(*context));
    return batches_(*context, batches);
  };
  Add(path, grpc::internal::RpcMethod::BIDI_STREAMING,
      std::make_unique<grpc::internal::TemplatedBidiStreamingHandler<BoundedBatches::Stream, false>>(run));
}

grpc::Status BoundedService::Refuse(const grpc::ServerContext& context, const absl::Status& refusal) const {
  frame_.unread.Sends(context, true, nullptr);
  return ToGrpcStatus(refusal);
}

void BoundedService::Add(const char* path, grpc::internal::RpcMethod::RpcType type,
                         std::unique_ptr<grpc::internal::MethodHandler> handler) {
  // The service owns the method, and the method owns the handler.
  AddMethod(new grpc::internal::RpcServiceMethod(path, type, new WatchedHandler(std::move(handler), frame_.unread)));
}

}  // namespace ricochet::server
