// Bytes: the input of a fuzz target as a script, from which it takes one number after another.

#ifndef RICOCHET_TESTS_FUZZ_BYTES_H_
#define RICOCHET_TESTS_FUZZ_BYTES_H_

#include <cstddef>
#include <cstdint>
#include <string>

namespace ricochet {

class Bytes {
 public:
  Bytes(const uint8_t* data, size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }
  // Returns 0 if no byte is left.
  uint8_t Byte() {
    if (empty()) return 0;
    --size_;
    return *data_++;
  }
  // Returns numbers of all magnitudes: one byte says by how much eight others are shifted.
  int64_t Number() {
    const int shift = Byte() % 64;
    uint64_t bits = 0;
    for (int i = 0; i < 8; ++i) bits = bits << 8U | Byte();
    return static_cast<int64_t>(bits) >> shift;
  }
  // Returns all that is left.
  std::string Rest() {
    std::string rest(reinterpret_cast<const char*>(data_), size_);
    size_ = 0;
    return rest;
  }

 private:
  const uint8_t* data_;
  size_t size_;
};

}  // namespace ricochet

#endif  // RICOCHET_TESTS_FUZZ_BYTES_H_
