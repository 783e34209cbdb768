#include "client/tls_files.h"

#include <openssl/err.h>
#include <openssl/x509.h>

#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "proto/wire/pem.h"
#include "ricochet/error.h"

namespace ricochet {
namespace {

using pem::Certificate;
using pem::Key;
using pem::ParseCertificate;
using pem::ParseKey;

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

}  // namespace

absl::StatusOr<std::string> ReadSecurityFile(const std::string& path, const char* option) {
  if (path.empty()) return std::string();
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (file && text.tellp() > 0) return text.str();
  return InvalidRequest({{option, absl::StrCat("= ", path, ": must be a file that can be read and is not empty")}});
}

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

}  // namespace ricochet
