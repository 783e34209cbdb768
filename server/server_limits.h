// ServerLimitsOf: the limits of a server beyond those of a request's size, as clients ask for them and the log states
// them.

#ifndef RICOCHET_SERVER_SERVER_LIMITS_H_
#define RICOCHET_SERVER_SERVER_LIMITS_H_

#include "ricochet/info.h"
#include "server/options.h"

namespace ricochet::server {

ServerLimits ServerLimitsOf(const Options& options);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SERVER_LIMITS_H_
