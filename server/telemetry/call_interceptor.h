// CallInterceptor: sees every call that gRPC hands to the service, those that end before a handler runs included.
//
// Such calls end because their bytes are no message, because no thread is free, or because there is no such method.
// Each gets a record like any other call. gRPC answers the first with INTERNAL and no text, and the second without
// saying when to try again: both get a status that says what is wrong.
//
// gRPC 1.51 ends some calls before it hands them on, and they are seen by nobody: messages and headers that are too
// large, and streams beyond the limit of a connection.

#ifndef RICOCHET_SERVER_TELEMETRY_CALL_INTERCEPTOR_H_
#define RICOCHET_SERVER_TELEMETRY_CALL_INTERCEPTOR_H_

#include <grpcpp/server_builder.h>

#include "server/telemetry/observer.h"

namespace ricochet::server {

// Makes the server that `builder` describes tell `observer` of its calls. The observer must outlive the server.
void WatchCalls(const Observer& observer, grpc::ServerBuilder& builder);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_TELEMETRY_CALL_INTERCEPTOR_H_
