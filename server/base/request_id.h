// The request id: a name for one call that stands in the caller's own records and in the log of every server on the
// way.

#ifndef RICOCHET_SERVER_BASE_REQUEST_ID_H_
#define RICOCHET_SERVER_BASE_REQUEST_ID_H_

#include <string>

#include "absl/strings/string_view.h"

namespace ricochet::server {

// The metadata in which a caller may send an id. The trailing metadata of every answer hold the one that was used.
inline constexpr char kRequestIdHeader[] = "x-request-id";

// Returns `sent` if it is an id: 1 to 128 printable ASCII characters other than space, quotes and backslash. Otherwise
// returns a new random id of 32 hexadecimal digits.
std::string RequestIdOr(absl::string_view sent);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_REQUEST_ID_H_
