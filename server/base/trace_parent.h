// The W3C header traceparent, by which a caller names the distributed trace that a call belongs to.
// https://www.w3.org/TR/trace-context/#traceparent-header

#ifndef RICOCHET_SERVER_BASE_TRACE_PARENT_H_
#define RICOCHET_SERVER_BASE_TRACE_PARENT_H_

#include <string>

#include "absl/strings/string_view.h"

namespace ricochet::server {

// Returns the trace id in the value of the header: 32 hexadecimal digits in lower case, not all of them 0. Returns an
// empty text for a value that the recommendation calls invalid, and which it wants to be treated as absent.
std::string TraceId(absl::string_view traceparent);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_BASE_TRACE_PARENT_H_
