#include "client/final_failure.h"

#include <array>
#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

struct Cause {
  const char* sign;  // A part of gRPC's message.
  const char* words;
  bool is_lasting;
};

constexpr char kClosed[] =
    "the server closed the connection: it has no room, or it wants TLS (security.tls, --tls) or another certificate of "
    "this client (security.tls_cert, --tls-cert)";

constexpr char kClosedUrl[] = "ricochet/connection_closed";

// The first whose sign is found counts, so that a special one stands before the kind that it belongs to.
constexpr std::array kCauses = {
    Cause{"certificate verify failed",
          "the server's certificate is not trusted: no authority of security.tls_ca (--tls-ca; default: those of the "
          "system) has issued it, or its time has ended",
          true},
    Cause{
        "is not in peer certificate",
        "the server's certificate is for another name: security.server_name (--server-name) says which one is expected",
        true},
    Cause{"wrong version number", "the server does not speak TLS", true},
    Cause{"Ssl handshake failed: SSL_ERROR_SSL", "the server and this client cannot agree on TLS", true},
    Cause{"Trying to connect an http1.x server", "the server speaks HTTP/1, so that it is no ricochetd", true},
    Cause{"Socket closed", kClosed, false},
    Cause{"Endpoint read failed", kClosed, false},
};

absl::Status ExplainConnection(const absl::Status& status) {
  for (const Cause& cause : kCauses) {
    if (!absl::StrContains(status.message(), cause.sign)) continue;
    const absl::StatusCode code = cause.is_lasting ? absl::StatusCode::kFailedPrecondition : status.code();
    absl::Status explained(code, absl::StrCat(cause.words, " (", status.message(), ")"));
    if (!cause.is_lasting) explained.SetPayload(kClosedUrl, absl::Cord());
    return explained;
  }
  return status;
}

}  // namespace

absl::Status ExplainFailure(const absl::Status& status) {
  const absl::string_view message = status.message();
  if (absl::IsUnauthenticated(status)) {
    return {status.code(), absl::StrCat(message,
                                        ": the server takes a token (security.token, --token-file, RICOCHET_TOKEN) or "
                                        "a certificate of this client (security.tls_cert, --tls-cert)")};
  }
  if (absl::IsPermissionDenied(status)) {
    return {status.code(), absl::StrCat(message,
                                        ": the scopes of this client's token or certificate, which the server's "
                                        "operator gives, do not have it")};
  }
  if (absl::IsUnavailable(status) && absl::StartsWith(message, "failed to connect to all addresses")) {
    return ExplainConnection(status);
  }
  if (absl::IsResourceExhausted(status) && absl::StrContains(message, "essage larger than max")) {
    return MakeError(status.code(), ErrorReason::kLimitExceeded, std::string(message));
  }
  if (absl::IsDeadlineExceeded(status) && message == "Deadline Exceeded") {
    return {status.code(),
            "no answer came before the deadline, which is that of the call (--deadline) or ClientOptions::deadline"};
  }
  return status;
}

bool IsClosedByServer(const absl::Status& status) { return status.GetPayload(kClosedUrl).has_value(); }

}  // namespace ricochet
