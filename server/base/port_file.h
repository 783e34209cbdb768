// The port file: it tells the port to a script that started a server on port 0.

#ifndef RICOCHET_SERVER_BASE_PORT_FILE_H_
#define RICOCHET_SERVER_BASE_PORT_FILE_H_

#include <string>

#include "absl/status/status.h"

namespace ricochet::server {

// Writes `port` and a newline. A reader sees no file, the old file or the complete new file, never a part of it.
// Errors: FAILED_PRECONDITION if the path is that of anything but a plain file, such as a device or a symbolic link,
// which would be replaced; those of the file system. The message names the path.
absl::Status WritePortFile(const std::string& path, int port);

// Removes the file if it is a plain file that still holds this port. Another server may have replaced it.
void RemovePortFile(const std::string& path, int port);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_PORT_FILE_H_
