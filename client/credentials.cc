#include "client/credentials.h"

#include <grpc/grpc_security_constants.h>
#include <grpcpp/security/auth_context.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"

namespace ricochet {
namespace {

bool IsUnixTarget(const std::string& target) {
  return absl::StartsWith(target, "unix:") || absl::StartsWith(target, "unix-abstract:");
}

// True for "127.0.0.1:1", "localhost:1", "[::1]:1" and lists of them, with or without a scheme of gRPC.
bool IsLoopbackTarget(const std::string& target) {
  absl::string_view addresses = target;
  for (const char* scheme : {"dns:///", "dns:", "ipv4:", "ipv6:"}) {
    if (absl::ConsumePrefix(&addresses, scheme)) break;
  }
  const std::vector<std::string> hosts = absl::StrSplit(std::string(addresses), ',');
  for (const std::string& host : hosts) {
    const bool is_ipv4 = absl::StartsWith(host, "127.") && host.find_first_not_of("0123456789.:") == std::string::npos;
    const bool is_name = host == "localhost" || absl::StartsWith(host, "localhost:");
    const bool is_ipv6 = host == "[::1]" || absl::StartsWith(host, "[::1]:");
    if (!is_ipv4 && !is_name && !is_ipv6) return false;
  }
  return true;
}

// A header can carry these characters only, and a token has no white space.
bool IsToken(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7F; });
}

absl::StatusOr<std::string> ReadFile(const std::string& path, const char* option) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (path.empty() || (file && text.tellp() > 0)) return path.empty() ? std::string() : text.str();
  return InvalidRequest({{option, absl::StrCat("= ", path, ": must be a file that can be read and is not empty")}});
}

// Adds the token to the headers of every call.
class TokenHeader final : public grpc::MetadataCredentialsPlugin {
 public:
  TokenHeader(std::string token, std::string file) : token_(std::move(token)), file_(std::move(file)) {}

  grpc::Status GetMetadata(grpc::string_ref /*service*/, grpc::string_ref /*method*/,
                           const grpc::AuthContext& /*connection*/,
                           std::multimap<grpc::string, grpc::string>* headers) override {
    std::string token = token_;
    if (!file_.empty()) {
      const absl::StatusOr<std::string> text = ReadFile(file_, "security.token_file");
      token = text.ok() ? std::string(absl::StripAsciiWhitespace(*text)) : "";
      // gRPC makes UNAVAILABLE of this status, and the call may be tried again.
      if (!IsToken(token)) return {grpc::StatusCode::UNAVAILABLE, absl::StrCat("no token in ", file_)};
    }
    headers->emplace("authorization", absl::StrCat("Bearer ", token));
    return grpc::Status::OK;
  }

 private:
  const std::string token_;
  const std::string file_;
};

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeTls(const SecurityOptions& options) {
  const auto ca = ReadFile(options.tls_ca, "security.tls_ca");
  if (!ca.ok()) return ca.status();
  const auto certificate = ReadFile(options.tls_cert, "security.tls_cert");
  if (!certificate.ok()) return certificate.status();
  const auto key = ReadFile(options.tls_key, "security.tls_key");
  if (!key.ok()) return key.status();
  return grpc::SslCredentials({.pem_root_certs = *ca, .pem_private_key = *key, .pem_cert_chain = *certificate});
}

// Connects without encryption. With a token gRPC itself breaks off a connection that leaves this host.
std::shared_ptr<grpc::ChannelCredentials> MakePlain(bool has_token, const std::string& target) {
  if (!has_token) return grpc::InsecureChannelCredentials();
  return grpc::experimental::LocalCredentials(IsUnixTarget(target) ? UDS : LOCAL_TCP);
}

}  // namespace

std::vector<Violation> SecurityViolations(const SecurityOptions& options, const std::string& target) {
  std::vector<Violation> violations;
  if (options.tls_cert.empty() != options.tls_key.empty()) {
    violations.push_back({options.tls_key.empty() ? "security.tls_key" : "security.tls_cert",
                          "is empty: must be set if the other one of tls_cert and tls_key is"});
  }
  const std::pair<const char*, const std::string*> of_tls[] = {{"security.tls_ca", &options.tls_ca},
                                                               {"security.tls_cert", &options.tls_cert},
                                                               {"security.server_name", &options.server_name}};
  for (const auto& [name, value] : of_tls) {
    if (!options.tls && !value->empty())
      violations.push_back({name, absl::StrCat("= ", *value, ": needs security.tls")});
  }
  const bool has_token = !options.token.empty() || !options.token_file.empty();
  if (!options.token.empty() && !options.token_file.empty()) {
    violations.push_back({"security.token", "is set: must not be if security.token_file is"});
  }
  // The token itself must not get into a log.
  if (!options.token.empty() && !IsToken(options.token)) {
    violations.push_back({"security.token", "is set: must have visible ASCII characters only"});
  }
  if (has_token && !options.tls && !IsUnixTarget(target) && !IsLoopbackTarget(target)) {
    violations.push_back({options.token.empty() ? "security.token_file" : "security.token",
                          "is set: needs security.tls unless the target is a Unix socket or a loopback address"});
  }
  return violations;
}

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeChannelCredentials(const SecurityOptions& options,
                                                                                 const std::string& target) {
  const bool has_token = !options.token.empty() || !options.token_file.empty();
  std::shared_ptr<grpc::ChannelCredentials> channel = MakePlain(has_token, target);
  if (options.tls) {
    auto tls = MakeTls(options);
    if (!tls.ok()) return tls.status();
    channel = *std::move(tls);
  }
  if (!has_token) return channel;
  // A loopback connection counts as one without security, so that no more can be asked for here.
  return grpc::CompositeChannelCredentials(channel,
                                           grpc::experimental::MetadataCredentialsFromPlugin(
                                               std::make_unique<TokenHeader>(options.token, options.token_file),
                                               options.tls ? GRPC_PRIVACY_AND_INTEGRITY : GRPC_SECURITY_NONE));
}

}  // namespace ricochet
