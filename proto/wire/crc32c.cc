#include "proto/wire/crc32c.h"

#include <isa-l/crc.h>

namespace ricochet {

// ISA-L inverts neither at the start nor at the end. It does not write to the buffer, although its type says so.
uint32_t ExtendCrc32c(uint32_t crc, std::string_view bytes) {
  auto* const data = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(bytes.data()));
  return ~crc32_iscsi(data, static_cast<int>(bytes.size()), ~crc);
}

}  // namespace ricochet
