#include "client/credentials.h"

#include <grpc/grpc_security_constants.h>
#include <grpcpp/security/auth_context.h>
#include <openssl/err.h>
#include <openssl/x509.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/server_address.h"
#include "core/base/try.h"
#include "proto/wire/pem.h"

namespace ricochet {
namespace {

using pem::Certificate;
using pem::Key;
using pem::ParseCertificate;
using pem::ParseKey;

// Reads a file of the option `option`. An empty path gives an empty text.
// Errors: INVALID_ARGUMENT that names the option, if the file cannot be read or is empty.
absl::StatusOr<std::string> ReadSecurityFile(const std::string& path, const char* option) {
  if (path.empty()) return std::string();
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (file && text.tellp() > 0) return text.str();
  return InvalidRequest({{option, absl::StrCat("= ", path, ": must be a file that can be read and is not empty")}});
}

// A header can carry these characters only, and a token has no white space.
bool IsToken(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7F; });
}

absl::StatusOr<std::string> ReadToken(const std::string& file) {
  constexpr char kOption[] = "security.token_file";
  RICOCHET_TRY(const std::string text, ReadSecurityFile(file, kOption));
  std::string token(absl::StripAsciiWhitespace(text));
  if (IsToken(token)) return token;
  return InvalidRequest({{kOption, absl::StrCat("= ", file, ": must hold a token of visible ASCII characters only")}});
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
      const absl::StatusOr<std::string> read = ReadToken(file_);
      // The file was right when the client was made. gRPC makes UNAVAILABLE of this status: it may be right again soon.
      if (!read.ok()) return {grpc::StatusCode::UNAVAILABLE, absl::StrCat("no token in ", file_)};
      token = *read;
    }
    headers->emplace("authorization", absl::StrCat("Bearer ", token));
    return grpc::Status::OK;
  }

 private:
  const std::string token_;
  const std::string file_;
};

// The contents of the files, in PEM form; empty for a file that is not named.
struct TlsFiles {
  std::string ca;
  std::string cert;
  std::string key;
};

Violation Holds(const char* option, const std::string& path, const char* rule) {
  return {option, absl::StrCat("= ", path, ": must hold ", rule)};
}

// Returns what is wrong with the contents of the files.
std::vector<Violation> Check(const TlsFiles& files, const SecurityOptions& options) {
  std::vector<Violation> violations;
  if (!files.ca.empty() && ParseCertificate(files.ca) == nullptr) {
    violations.push_back(Holds("security.tls_ca", options.tls_ca, "a certificate in PEM form"));
  }
  if (files.cert.empty()) return violations;
  const Certificate certificate = ParseCertificate(files.cert);
  const Key key = ParseKey(files.key);
  if (certificate == nullptr) {
    violations.push_back(Holds("security.tls_cert", options.tls_cert, "a certificate in PEM form"));
  } else if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0) {
    violations.push_back(Holds("security.tls_cert", options.tls_cert, "a certificate whose time has not ended"));
  }
  if (key == nullptr) {
    violations.push_back(
        Holds("security.tls_key", options.tls_key, "a private key in PEM form, without a pass phrase"));
  } else if (certificate != nullptr && X509_check_private_key(certificate.get(), key.get()) != 1) {
    violations.push_back(Holds("security.tls_key", options.tls_key, "the private key of security.tls_cert"));
  }
  return violations;
}

// Reads the files and checks that they hold certificates and the key of the client's certificate, and that this
// certificate has not ended. Errors: INVALID_ARGUMENT with a violation for each option whose file is wrong.
// gRPC says of a file that holds no key only that a server is unavailable, so that a program would try again for ever.
absl::StatusOr<TlsFiles> ReadTlsFiles(const SecurityOptions& options) {
  auto ca = ReadSecurityFile(options.tls_ca, "security.tls_ca");
  auto cert = ReadSecurityFile(options.tls_cert, "security.tls_cert");
  auto key = ReadSecurityFile(options.tls_key, "security.tls_key");
  for (const auto* text : {&ca, &cert, &key}) {
    if (!text->ok()) return text->status();
  }
  TlsFiles files = {.ca = *std::move(ca), .cert = *std::move(cert), .key = *std::move(key)};
  const std::vector<Violation> violations = Check(files, options);
  // gRPC would take what is left here for an error of its own.
  ERR_clear_error();
  if (!violations.empty()) return InvalidRequest(violations);
  return files;
}

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> MakeTls(const SecurityOptions& options) {
  RICOCHET_TRY(const TlsFiles files, ReadTlsFiles(options));
  return grpc::SslCredentials({.pem_root_certs = files.ca, .pem_private_key = files.key, .pem_cert_chain = files.cert});
}

// Connects without encryption. With a token gRPC itself breaks off a connection that leaves this host.
std::shared_ptr<grpc::ChannelCredentials> MakePlain(bool has_token, const std::string& target) {
  if (!has_token) return grpc::InsecureChannelCredentials();
  return grpc::experimental::LocalCredentials(IsUnixAddress(target) ? UDS : LOCAL_TCP);
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
  if (has_token && !options.tls && !IsUnixAddress(target) && !IsLoopbackAddress(target)) {
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
    RICOCHET_TRY(channel, MakeTls(options));
  }
  if (!has_token) return channel;
  if (!options.token_file.empty()) {
    if (const absl::Status wrong = ReadToken(options.token_file).status(); !wrong.ok()) return wrong;
  }
  // A loopback connection counts as one without security, so that no more can be asked for here.
  return grpc::CompositeChannelCredentials(channel,
                                           grpc::experimental::MetadataCredentialsFromPlugin(
                                               std::make_unique<TokenHeader>(options.token, options.token_file),
                                               options.tls ? GRPC_PRIVACY_AND_INTEGRITY : GRPC_SECURITY_NONE));
}

}  // namespace ricochet
