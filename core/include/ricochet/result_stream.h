// ResultStream: the answers of a streaming call as a move-only input range of absl::StatusOr<T>.
//
//   for (absl::StatusOr<SweepChunk>& chunk : solver.Sweep(request)) {
//     if (!chunk.ok()) return chunk.status();
//     Use(*chunk);
//   }
//
// An error is the last element; a range that ends without one is complete. Destroying the stream cancels the call and
// finishes it. Thread safety: one thread at a time.

#ifndef RICOCHET_RESULT_STREAM_H_
#define RICOCHET_RESULT_STREAM_H_

#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "absl/functional/any_invocable.h"
#include "absl/status/statusor.h"

namespace ricochet {

template <typename T>
class ResultStream {
 public:
  // A source gives the next element, or nothing at the end. It is not called again after nothing or an error, and it is
  // destroyed with the stream.
  using Source = absl::AnyInvocable<std::optional<absl::StatusOr<T>>()>;

  explicit ResultStream(Source source) : source_(std::move(source)) {}

  // Makes a stream of one error.
  explicit ResultStream(absl::Status error)
      : source_([error = std::move(error)]() -> std::optional<absl::StatusOr<T>> { return error; }) {}

  ResultStream(ResultStream&&) noexcept = default;
  ResultStream& operator=(ResultStream&&) noexcept = default;

  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = absl::StatusOr<T>;
    using difference_type = std::ptrdiff_t;
    using pointer = value_type*;
    using reference = value_type&;

    Iterator() = default;
    explicit Iterator(ResultStream* stream) : stream_(stream) {}

    reference operator*() const { return *stream_->current_; }
    pointer operator->() const { return &*stream_->current_; }
    Iterator& operator++() {
      stream_->Advance();
      return *this;
    }
    void operator++(int) { ++*this; }

    bool operator==(std::default_sentinel_t /*end*/) const { return !stream_->current_.has_value(); }

   private:
    ResultStream* stream_ = nullptr;
  };

  // Reads the first element. Call it once.
  Iterator begin() {
    Advance();
    return Iterator(this);
  }
  std::default_sentinel_t end() const { return {}; }

 private:
  void Advance() {
    const bool failed = current_.has_value() && !current_->ok();
    current_.reset();
    if (!failed) current_ = source_();
  }

  Source source_;
  std::optional<absl::StatusOr<T>> current_;
};

}  // namespace ricochet

#endif  // RICOCHET_RESULT_STREAM_H_
