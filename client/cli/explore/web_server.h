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
  // Answers a request, or one that was refused. Several threads call it at once.
  using Answer = std::function<void(Exchange&, const absl::Status& allowed)>;

  // Starts to serve. `host` is an IP address, with brackets if it is one of IPv6; port 0 lets the system choose.
  // Errors: UNAVAILABLE if it cannot listen there.
  static absl::StatusOr<std::unique_ptr<WebServer>> Start(std::string host, int port, Answer answer);

  // Waits for the answers that are on their way.
  ~WebServer();
  WebServer(const WebServer&) = delete;

  // Returns the address of the page, with the port that the system chose and the token.
  std::string url() const { return "http://" + authority() + "/?token=" + token_; }

 private:
  WebServer(std::string host, int port, Answer answer)
      : host_(std::move(host)), port_(port), answer_(std::move(answer)) {}
  std::string authority() const { return host_ + ":" + std::to_string(port_); }
  absl::Status Check(const Exchange& exchange) const;
  bool IsOwn(absl::string_view authority) const;
  static int Handle(mg_connection* connection, void* server);

  const std::string host_, token_ = RandomHex();
  int port_;
  const Answer answer_;
  mg_context* web_ = nullptr;
};

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXPLORE_WEB_SERVER_H_
