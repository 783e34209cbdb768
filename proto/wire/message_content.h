// MessageContent: what the bytes of a request hold, read before anything is made of them.
//
// Protobuf keeps a field or an enum value that it does not know aside and says nothing, so that the effect which a
// newer client states would be missing from the answer. And half a million empty messages fit into 1 MiB, each of which
// takes a hundred bytes once it is parsed.

#ifndef RICOCHET_PROTO_WIRE_MESSAGE_CONTENT_H_
#define RICOCHET_PROTO_WIRE_MESSAGE_CONTENT_H_

#include <google/protobuf/descriptor.h>

#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace ricochet {

// Reads the bytes of a message of type `type`, and returns how many messages and texts it holds.
// Errors: INVALID_ARGUMENT names the first field whose number or wire type the type does not have, or whose enum does
// not have its value; RESOURCE_EXHAUSTED with ErrorReason::kLimitExceeded if there are more than `most` messages and
// texts. Bytes that are no message are left to the parser.
absl::StatusOr<int64_t> CheckContent(absl::string_view bytes, const google::protobuf::Descriptor& type, int64_t most);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_MESSAGE_CONTENT_H_
