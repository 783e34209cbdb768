// WebServer: answers HTTP/1.1 at one address, and only to those who know its token.
//
// A page of somebody else, open in the same browser, must neither ask nor read anything here. Every request needs the
// token, as "?token=..." or "Authorization: Bearer ...". Its Host must be an address of this server, so that no name
// can be bound to it anew, and its Origin, if it has one, the same. No answer may be read across origins. A request
// that is sent too slowly is dropped; a body has at most 1 MiB, the limit of ricochetd.

#ifndef RICOCHET_CLIENT_CLI_EXPLORE_WEB_SERVER_H_
#define RICOCHET_CLIENT_CLI_EXPLORE_WEB_SERVER_H_

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

struct mg_connection;
struct mg_context;

namespace ricochet::cli {

// Returns 32 random hexadecimal digits that nobody can guess.
std::string RandomHex();

// One request, which is to be answered once.
class Exchange {
 public:
  explicit Exchange(mg_connection* connection) : connection_(connection) {}

  absl::string_view method() const;
  absl::string_view path() const;  // "/ricochet.v1.ImpactService/Solve".
  // These return nothing for what the request does not have.
  std::string Query(const std::string& name) const;
  std::string Header(const std::string& name) const;

  // Reads the whole body. Errors: RESOURCE_EXHAUSTED for one that is too long, DATA_LOSS for one that comes too slowly.
  absl::StatusOr<std::string> Body();

  // Answers. `headers` are further lines, each with CRLF.
  void Reply(int status, absl::string_view type, absl::string_view body, absl::string_view headers = "");

 private:
  mg_connection* connection_;
};

class WebServer {
 public:
  struct Options {
    std::string host;  // An IP address, with brackets if it is one of IPv6.
    int port = 0;      // 0 lets the system choose.
    std::string token;
    // Answers a request, or one that was refused. Several threads call it at once.
    std::function<void(Exchange&, const absl::Status& allowed)> answer;
  };

  // Starts to serve. Errors: UNAVAILABLE if it cannot listen there.
  static absl::StatusOr<std::unique_ptr<WebServer>> Start(Options options);

  // Waits for the answers that are on their way.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Returns HOST:PORT with the port that the system chose.
  std::string authority() const;

 private:
  explicit WebServer(Options options) : options_(std::move(options)) {}
  absl::Status Listen();
  absl::Status Check(const Exchange& exchange) const;
  bool IsOwn(absl::string_view authority) const;
  static int Handle(mg_connection* connection, void* server);

  Options options_;
  mg_context* web_ = nullptr;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXPLORE_WEB_SERVER_H_
