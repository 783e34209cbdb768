// The port file: how a script that started a server on port 0 learns the port.

#ifndef RICOCHET_SERVER_PORT_FILE_H_
#define RICOCHET_SERVER_PORT_FILE_H_

#include <string>

#include "absl/status/status.h"

namespace ricochet::server {

// Writes `port` and a newline. A reader sees no file, the old one or the whole new one, never a part.
// Errors: those of the file system, naming the path.
absl::Status WritePortFile(const std::string& path, int port);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_PORT_FILE_H_
