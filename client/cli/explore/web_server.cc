#include "client/cli/explore/web_server.h"

#include <civetweb.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numeric>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/server_address.h"

namespace ricochet::cli {
namespace {

// A connection holds a thread while it is open, and a browser opens six. The others are for those who send half of a
// request or nothing at all, which takes kSlowest; civetweb takes a thread for them before it knows who asks.
constexpr char kThreads[] = "512";
constexpr char kSlowest[] = "5000";  // ms.

constexpr char kBearer[] = "Bearer ";

constexpr size_t kMostBodyBytes = size_t{1} << 20;

// These headers keep a browser from storing an answer, guessing its type or giving it to pages of other origins.
constexpr char kHeaders[] =
    "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: same-origin\r\n";

// Takes the same time wherever two texts of one length differ, so that the time tells nobody how much was right.
bool IsSame(absl::string_view a, absl::string_view b) {
  return a.size() == b.size() &&
         std::transform_reduce(a.begin(), a.end(), b.begin(), 0, std::bit_or<>(), std::bit_xor<>()) == 0;
}

}  // namespace

std::string RandomHex() {
  std::array<char, 16> bytes = {};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) std::abort();
  return absl::BytesToHexString({bytes.data(), bytes.size()});
}

absl::string_view Exchange::method() const { return mg_get_request_info(connection_)->request_method; }

absl::string_view Exchange::path() const { return mg_get_request_info(connection_)->local_uri; }

std::string Exchange::Query(const std::string& name) const {
  const char* const query = mg_get_request_info(connection_)->query_string;
  std::array<char, 256> value = {};
  if (query == nullptr) return "";
  return mg_get_var(query, std::strlen(query), name.c_str(), value.data(), value.size()) < 0 ? "" : value.data();
}

std::string Exchange::Header(const std::string& name) const {
  const char* const value = mg_get_header(connection_, name.c_str());
  return value == nullptr ? "" : value;
}

absl::StatusOr<std::string> Exchange::Body() {
  const int64_t length = mg_get_request_info(connection_)->content_length;  // < 0 if the request does not say it.
  std::string body;
  std::vector<char> buffer(size_t{64} << 10);
  int count = 1;
  while (count > 0 && body.size() <= kMostBodyBytes && length <= static_cast<int64_t>(kMostBodyBytes)) {
    count = mg_read(connection_, buffer.data(), buffer.size());
    body.append(buffer.data(), static_cast<size_t>(std::max(count, 0)));
  }
  if (count == 0 && static_cast<int64_t>(body.size()) >= length) return body;
  mg_disable_connection_keep_alive(connection_);
  if (count > 0)
    return absl::ResourceExhaustedError(absl::StrCat("the body must have at most ", kMostBodyBytes, " bytes"));
  return absl::DataLossError(absl::StrCat("only ", body.size(), " bytes of the body came in time"));
}

void Exchange::Reply(int status, absl::string_view type, absl::string_view body, absl::string_view headers) {
  const std::string text = absl::StrCat("HTTP/1.1 ", status, " ", mg_get_response_code_text(connection_, status),
                                        "\r\nContent-Type: ", type, "\r\nContent-Length: ", body.size(), "\r\n",
                                        kHeaders, headers, "\r\n", method() == "HEAD" ? "" : body);
  mg_write(connection_, text.data(), text.size());
}

absl::StatusOr<std::unique_ptr<WebServer>> WebServer::Start(std::string host, int port, Answer answer) {
  mg_init_library(0);
  std::unique_ptr<WebServer> server(new WebServer(std::move(host), port, std::move(answer)));
  const std::string where = server->authority();
  const std::array<const char*, 17> settings = {
      "listening_ports", where.c_str(), "num_threads", kThreads, "request_timeout_ms", kSlowest, "enable_keep_alive",
      "yes", "keep_alive_timeout_ms", kSlowest, "tcp_nodelay", "1",
      // civetweb would itself allow every origin.
      "access_control_allow_origin", "", "access_control_allow_methods", "", nullptr};
  std::array<char, 256> reason = {};
  auto* const text = const_cast<const char**>(settings.data());
  mg_init_data how = {.callbacks = nullptr, .user_data = server.get(), .configuration_options = text};
  mg_error_data error = {.code = nullptr, .text = reason.data(), .text_buffer_size = reason.size()};
  mg_context* const web = server->web_ = mg_start2(&how, &error);
  if (web == nullptr) {
    return absl::UnavailableError(
        absl::StrCat("cannot listen at ", where, ": ", reason.data(), "; is the address in use?"));
  }
  mg_server_port bound = {};
  if (mg_get_server_ports(web, 1, &bound) == 1) server->port_ = bound.port;
  mg_set_request_handler(web, "/", &Handle, server.get());
  return server;
}

WebServer::~WebServer() {
  if (web_ != nullptr) mg_stop(web_);
  mg_exit_library();
}

// Only a host name can be rebound to another address, so that any IP address is accepted beyond loopback, where this
// server may have several.
bool WebServer::IsOwn(absl::string_view authority) const {
  if (authority.empty()) return false;
  // Clients leave out the port 80, which http:// stands for.
  constexpr int kDefaultPort = 80;
  const bool has_port = authority.find(':', authority.find(']') + 1) != authority.npos;
  if (has_port ? !absl::EndsWith(authority, absl::StrCat(":", port_)) : port_ != kDefaultPort) return false;
  if (IsLoopbackAddress(authority)) return true;
  const bool is_address = authority.front() == '[' || authority.find_first_not_of("0123456789.:") == authority.npos;
  return is_address && !IsLoopbackAddress(host_);
}

absl::Status WebServer::Check(const Exchange& exchange) const {
  const std::string host = exchange.Header("Host");
  if (!IsOwn(host)) return absl::PermissionDeniedError(absl::StrCat("Host ", host, ": must be ", authority()));
  const std::string origin = exchange.Header("Origin");
  absl::string_view sender = origin;
  if (!origin.empty() && !(absl::ConsumePrefix(&sender, "http://") && IsOwn(sender))) {
    return absl::PermissionDeniedError(absl::StrCat("Origin ", origin, ": must be http://", authority(), " or absent"));
  }
  const std::string header = exchange.Header("Authorization");
  absl::string_view token = header;
  const bool is_bearer = absl::StartsWithIgnoreCase(token, kBearer);
  if (is_bearer) token.remove_prefix(sizeof(kBearer) - 1);
  if ((is_bearer && IsSame(token, token_)) || IsSame(exchange.Query("token"), token_)) return absl::OkStatus();
  return absl::UnauthenticatedError(
      "the token must be that which ricochet explore has printed, as ?token=... or as Authorization: Bearer ...");
}

int WebServer::Handle(mg_connection* connection, void* server) {
  const auto& self = *static_cast<const WebServer*>(server);
  Exchange exchange(connection);
  const absl::Status allowed = self.Check(exchange);
  if (!allowed.ok()) mg_disable_connection_keep_alive(connection);
  // A thread of civetweb has a stack of 100 KiB, which is too small to compute on. The system may have no thread left,
  // and an exception must not get into civetweb.
  try {
    std::thread([&] { self.answer_(exchange, allowed); }).join();
  } catch (const std::system_error&) {
    exchange.Reply(503, "text/plain", "the system has no thread left\n", "");
  }
  return 1;
}

}  // namespace ricochet::cli
