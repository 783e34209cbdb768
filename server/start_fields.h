// The fields of the log's first record: which server this is, where it listens and within which limits.

#ifndef RICOCHET_SERVER_START_FIELDS_H_
#define RICOCHET_SERVER_START_FIELDS_H_

#include <vector>

#include "server/base/log.h"
#include "server/options.h"

namespace ricochet::server {

std::vector<LogField> StartFields(const Options& options);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_START_FIELDS_H_
