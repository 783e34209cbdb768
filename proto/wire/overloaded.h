// Overloaded: joins several lambdas into one function object, for std::visit without a default branch.

#ifndef RICOCHET_PROTO_WIRE_OVERLOADED_H_
#define RICOCHET_PROTO_WIRE_OVERLOADED_H_

namespace ricochet {

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_OVERLOADED_H_
