// The limit of open file descriptors of this process, and how many connections it leaves room for.

#ifndef RICOCHET_SERVER_BASE_DESCRIPTOR_LIMIT_H_
#define RICOCHET_SERVER_BASE_DESCRIPTOR_LIMIT_H_

#include <cstdint>

namespace ricochet::server {

// Raises the soft limit of open descriptors to the hard limit, which shells and service managers often leave at 1024.
// Returns the limit that then holds.
int64_t RaiseDescriptorLimit();

// Returns how many connections fit below `descriptors`, at least 1: each takes two, and 32 stay free for the rest of
// the process.
int64_t ConnectionsBelow(int64_t descriptors);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_DESCRIPTOR_LIMIT_H_
