#include "client/cli/terminal/grpc_log.h"

#include <grpc/support/log.h>

#include <cstdlib>
#include <mutex>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/final_failure.h"

namespace ricochet::cli {
namespace {

// The last alert that a server sent. Threads of gRPC write it.
struct Alert {
  std::mutex mutex;
  std::string text;
};

Alert& LastAlert() {
  static auto* const alert = new Alert;
  return *alert;
}

// Keeps the alert of a line such as "error:0A00045C:SSL routines::tlsv13 alert certificate required".
void KeepAlert(gpr_log_func_args* line) {
  const absl::string_view message = line->message;
  if (!absl::StrContains(message, " alert ")) return;
  const size_t start = message.rfind(':');
  Alert& alert = LastAlert();
  const std::lock_guard lock(alert.mutex);
  alert.text = std::string(message.substr(start == absl::string_view::npos ? 0 : start + 1));
}

}  // namespace

void QuietGrpc() {
  if (std::getenv("GRPC_VERBOSITY") == nullptr) gpr_set_log_function(KeepAlert);
}

absl::Status WithTlsAlert(const absl::Status& status) {
  if (!IsClosedByServer(status)) return status;
  Alert& alert = LastAlert();
  const std::lock_guard lock(alert.mutex);
  if (alert.text.empty()) return status;
  return absl::FailedPreconditionError(absl::StrCat("the server refuses this client: ", alert.text,
                                                    "; --tls-cert and --tls-key say which certificate it is shown"));
}

}  // namespace ricochet::cli
