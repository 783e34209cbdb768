#include "server/security/tls_files.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <memory>

#include "absl/strings/str_cat.h"
#include "proto/wire/pem.h"

namespace ricochet::server {
namespace {

using pem::Bio;
using pem::Certificate;
using pem::Key;
using pem::ParseCertificate;
using pem::ParseKey;
using Context = std::unique_ptr<SSL_CTX, pem::Free<SSL_CTX_free>>;

absl::Status HoldsNo(const std::string& what, const WatchedFile& file) {
  return absl::InvalidArgumentError(absl::StrCat(file.path(), " holds no ", what, " in PEM form"));
}

// Returns why TLS refuses the certificate, such as a key that is too short for the system's policy, or an empty text.
std::string WhyUnusable(X509* certificate) {
  const Context context(SSL_CTX_new(TLS_server_method()));
  if (context != nullptr && SSL_CTX_use_certificate(context.get(), certificate) == 1) return "";
  const char* const reason = ERR_reason_error_string(ERR_peek_last_error());
  ERR_clear_error();
  return reason == nullptr ? "unknown reason" : reason;
}

std::string Printed(const Bio& bio) {
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  return {text, static_cast<size_t>(size)};
}

}  // namespace

TlsFiles::TlsFiles(const TlsPaths& paths) : certificate_(paths.certificate), key_(paths.key) {
  if (!paths.client_ca.empty()) client_ca_.emplace(paths.client_ca);
}

bool TlsFiles::HaveChanged() const {
  return certificate_.HasChanged() || key_.HasChanged() || (client_ca_.has_value() && client_ca_->HasChanged());
}

absl::StatusOr<TlsContents> TlsFiles::Read() {
  // All are read before any is checked: a file that was not read would count as changed at the next look.
  const absl::StatusOr<std::string> certificate = certificate_.Read();
  const absl::StatusOr<std::string> key = key_.Read();
  const absl::StatusOr<std::string> client_ca = client_ca_.has_value() ? client_ca_->Read() : std::string();
  for (const auto* text : {&certificate, &key, &client_ca}) {
    if (!text->ok()) return text->status();
  }
  const Certificate parsed = ParseCertificate(*certificate);
  if (parsed == nullptr) return HoldsNo("certificate", certificate_);
  const Key parsed_key = ParseKey(*key);
  if (parsed_key == nullptr) return HoldsNo("private key without a pass phrase", key_);
  if (client_ca_.has_value() && ParseCertificate(*client_ca) == nullptr) return HoldsNo("certificate", *client_ca_);
  if (X509_check_private_key(parsed.get(), parsed_key.get()) != 1) {
    ERR_clear_error();
    return absl::InvalidArgumentError(
        absl::StrCat("the key in ", key_.path(), " is not that of the certificate in ", certificate_.path()));
  }
  if (const std::string reason = WhyUnusable(parsed.get()); !reason.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("the certificate in ", certificate_.path(), " cannot be used for TLS: ", reason));
  }
  return TlsContents{.certificate = *certificate, .key = *key, .client_ca = *client_ca};
}

std::vector<LogField> DescribeCertificate(const std::string& pem) {
  const Certificate certificate = ParseCertificate(pem);
  if (certificate == nullptr) return {};
  const Bio subject(BIO_new(BIO_s_mem()));
  X509_NAME_print_ex(subject.get(), X509_get_subject_name(certificate.get()), 0,
                     XN_FLAG_ONELINE & ~ASN1_STRFLGS_ESC_MSB);
  const Bio end(BIO_new(BIO_s_mem()));
  ASN1_TIME_print(end.get(), X509_get0_notAfter(certificate.get()));
  return {{"subject", Printed(subject)}, {"valid_until", Printed(end)}};
}

}  // namespace ricochet::server
