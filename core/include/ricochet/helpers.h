// Helpers: lends other threads to a call whose parts can be computed side by side.
//
// No result depends on who helps, or on how many do.

#ifndef RICOCHET_HELPERS_H_
#define RICOCHET_HELPERS_H_

#include "absl/functional/any_invocable.h"
#include "absl/functional/function_ref.h"

namespace ricochet {

// Returns the number of cores that this thread may use, >= 1.
int AvailableCores();

// Thread safety: every method may be called from several threads at once.
class Helpers {
 public:
  // A Help computes parts of a call until it finds none. Every millisecond or so it asks `gives_way`, and it returns
  // once that says true.
  using Help = absl::AnyInvocable<void(absl::FunctionRef<bool()> gives_way)>;

  virtual ~Helpers() = default;

  // The most threads that can help at once, >= 0.
  virtual int most() const = 0;

  // Has `help` called on another thread soon and returns true; or returns false, at once, if no thread is free. The
  // thread that calls Start never calls `help` itself.
  virtual bool Start(Help help) = 0;
};

}  // namespace ricochet

#endif  // RICOCHET_HELPERS_H_
