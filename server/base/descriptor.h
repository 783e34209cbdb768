// Descriptor: owns an open file descriptor and closes it at its end.

#ifndef RICOCHET_SERVER_BASE_DESCRIPTOR_H_
#define RICOCHET_SERVER_BASE_DESCRIPTOR_H_

#include <unistd.h>

#include <utility>

namespace ricochet::server {

class Descriptor {
 public:
  // Owns nothing.
  Descriptor() = default;
  // Takes `number` over; a negative number means none.
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.Release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }

  bool is_open() const { return number_ >= 0; }
  int number() const { return number_; }

  // Gives the descriptor to the caller, who must close it.
  int Release() { return std::exchange(number_, -1); }

 private:
  int number_ = -1;
};

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_DESCRIPTOR_H_
