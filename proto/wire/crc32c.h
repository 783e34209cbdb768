// CRC-32C: the checksum of RFC 3720 (polynomial of Castagnoli).

#ifndef RICOCHET_PROTO_WIRE_CRC32C_H_
#define RICOCHET_PROTO_WIRE_CRC32C_H_

#include <cstdint>
#include <string_view>

namespace ricochet {

// Returns the checksum of bytes that go on with `bytes` after a part whose checksum is `crc`, which is 0 for no bytes.
// At most 2 GiB in one call.
uint32_t ExtendCrc32c(uint32_t crc, std::string_view bytes);

}  // namespace ricochet

#endif  // RICOCHET_PROTO_WIRE_CRC32C_H_
