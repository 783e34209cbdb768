// Fill: sets every field of a proto message, each scalar to a different value.
//
// A conversion that forgets a field, or swaps two, does not give such a message back.

#ifndef RICOCHET_TESTS_PROTO_FILL_H_
#define RICOCHET_TESTS_PROTO_FILL_H_

#include <google/protobuf/message.h>

namespace ricochet {

// Sets the member number `choice` (modulo their number) of each oneof. Lists get two entries. Enum values are taken in
// their order, so that the entries of a list differ; none is the value 0.
void Fill(int choice, google::protobuf::Message& message);

// Sets each number that may be absent from a filled message, or from a part of it, to 0, or makes it absent.
void SetToZero(google::protobuf::Message& message);
void MakeAbsent(google::protobuf::Message& message);

}  // namespace ricochet

#endif  // RICOCHET_TESTS_PROTO_FILL_H_
