// Fill: a proto message with every field set, each scalar to a value of its own.
//
// A conversion that forgets a field, or that swaps two, does not give such a message back.

#ifndef RICOCHET_TESTS_PROTO_FILL_H_
#define RICOCHET_TESTS_PROTO_FILL_H_

#include <google/protobuf/message.h>

namespace ricochet {

// Of each oneof, the member number `choice` (modulo their number) is set. Lists have two entries. Enum values are
// taken in their order, so that a list's entries differ; none is the one of number 0.
void Fill(int choice, google::protobuf::Message& message);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_PROTO_FILL_H_
