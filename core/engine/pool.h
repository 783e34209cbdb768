// Pool: objects that a thread takes for a while and that the next thread takes after it, because making them costs
// time.

#ifndef RICOCHET_CORE_ENGINE_POOL_H_
#define RICOCHET_CORE_ENGINE_POOL_H_

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "absl/functional/any_invocable.h"

namespace ricochet {

// Thread safety: several threads may call it at once.
template <typename T>
class Pool {
 public:
  // `make` makes a new object; several threads may call it at once.
  explicit Pool(absl::AnyInvocable<std::unique_ptr<T>() const> make) : make_(std::move(make)) {}

  // Gives the object back to its pool in place of destroying it. The pool must outlive it.
  struct GiveBack {
    Pool* pool = nullptr;
    void operator()(T* object) const { pool->PutBack(std::unique_ptr<T>(object)); }
  };
  using Taken = std::unique_ptr<T, GiveBack>;

  Taken Take() {
    std::unique_ptr<T> object = TakeSpare();
    if (object == nullptr) object = make_();
    return Taken(object.release(), GiveBack{this});
  }

 private:
  std::unique_ptr<T> TakeSpare() {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return nullptr;
    std::unique_ptr<T> object = std::move(spare_.back());
    spare_.pop_back();
    return object;
  }
  void PutBack(std::unique_ptr<T> object) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(object));
  }

  const absl::AnyInvocable<std::unique_ptr<T>() const> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> spare_;
};

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_POOL_H_
