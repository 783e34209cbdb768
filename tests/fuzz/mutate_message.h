// The interface between a fuzz target whose input is a serialized message and the mutator of messages
// (tests/fuzz/mutate_message.cc).

#ifndef RICOCHET_TESTS_FUZZ_MUTATE_MESSAGE_H_
#define RICOCHET_TESTS_FUZZ_MUTATE_MESSAGE_H_

#include <google/protobuf/message.h>

#include <memory>
#include <string>
#include <vector>

namespace ricochet {

// An empty message of the target's type.
std::unique_ptr<google::protobuf::Message> NewInput();

// The texts that a field of that message may take, such as paths of numbers. Empty if it has no texts.
std::vector<std::string> InputTexts();

}  // namespace ricochet

#endif  // RICOCHET_TESTS_FUZZ_MUTATE_MESSAGE_H_
