// gRPC's own C++ classes offer either TLS whose files, once broken, cut off every new client
// (FileWatcherCertificateProvider takes up a certificate whose key does not fit), or calls checked only over TLS. Its C
// interface has what is needed: a fetcher of certificates that keeps the old ones after a failure, and a check of calls
// for any credentials.

#include "server/security/credentials.h"

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>
#include <grpc/slice.h>

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/base/request_id.h"

namespace ricochet::server {
namespace {

std::string Text(const grpc_slice& slice) {
  return {reinterpret_cast<const char*>(GRPC_SLICE_START_PTR(slice)), GRPC_SLICE_LENGTH(slice)};
}

// Gives gRPC the certificates when it asks for them.
class Certificates {
 public:
  Certificates(const TlsPaths& paths, const Log& log) : log_(log), files_(paths) {}

  absl::Status Load() {
    absl::StatusOr<TlsContents> contents = files_.Read();
    if (!contents.ok()) return contents.status();
    log_.Write(LogLevel::kInfo, "certificate read", DescribeCertificate(contents->certificate));
    fresh_ = *std::move(contents);
    return absl::OkStatus();
  }

  grpc_ssl_certificate_config_reload_status Fetch(grpc_ssl_server_certificate_config** config) {
    const std::lock_guard lock(mutex_);
    if (!fresh_.has_value() && files_.HaveChanged()) {
      if (const absl::Status loaded = Load(); !loaded.ok()) {
        log_.Write(LogLevel::kError, "certificate not read", {{"reason", std::string(loaded.message())}});
      }
    }
    if (!fresh_.has_value()) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    const grpc_ssl_pem_key_cert_pair pair = {.private_key = fresh_->key.c_str(),
                                             .cert_chain = fresh_->certificate.c_str()};
    // gRPC insists on authorities even where no client is asked for a certificate; they are not used then.
    const std::string& roots = fresh_->client_ca.empty() ? fresh_->certificate : fresh_->client_ca;
    *config = grpc_ssl_server_certificate_config_create(roots.c_str(), &pair, 1);
    fresh_.reset();
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

 private:
  const Log& log_;
  std::mutex mutex_;
  TlsFiles files_;
  std::optional<TlsContents> fresh_;  // Read, and not yet fetched.
};

std::vector<std::string> CertificateNames(const grpc_auth_context* connection) {
  std::vector<std::string> names;
  grpc_auth_property_iterator type =
      grpc_auth_context_find_properties_by_name(connection, GRPC_TRANSPORT_SECURITY_TYPE_PROPERTY_NAME);
  const grpc_auth_property* property = grpc_auth_property_iterator_next(&type);
  if (property == nullptr || std::string(property->value, property->value_length) != GRPC_SSL_TRANSPORT_SECURITY_TYPE) {
    return names;
  }
  grpc_auth_property_iterator identity = grpc_auth_context_peer_identity(connection);
  while ((property = grpc_auth_property_iterator_next(&identity)) != nullptr) {
    names.emplace_back(property->value, property->value_length);
  }
  return names;
}

void Check(void* state, grpc_auth_context* connection, const grpc_metadata* headers, size_t count,
           grpc_process_auth_metadata_done_cb done, void* call) {
  Evidence evidence;
  evidence.certificate_names = CertificateNames(connection);
  for (const grpc_metadata* header = headers; header != headers + count; ++header) {
    const std::string name = Text(header->key);
    if (name == ":path") evidence.method = Text(header->value);
    if (name == "user-agent") evidence.user_agent = Text(header->value);
    if (name == kRequestIdHeader) evidence.request_id = Text(header->value);
    if (name == "authorization") evidence.authorization.push_back(Text(header->value));
  }
  const absl::Status status = static_cast<Auth*>(state)->Check(evidence);
  done(call, nullptr, 0, nullptr, 0, static_cast<grpc_status_code>(status.code()),
       status.ok() ? nullptr : std::string(status.message()).c_str());
}

class Credentials final : public grpc::ServerCredentials {
 public:
  Credentials(std::unique_ptr<Certificates> certificates, bool clients_have_certificates, std::shared_ptr<Auth> auth)
      : certificates_(std::move(certificates)), auth_(std::move(auth)) {
    if (certificates_ == nullptr) {
      credentials_ = grpc_insecure_server_credentials_create();
    } else {
      credentials_ = grpc_ssl_server_credentials_create_with_options(
          grpc_ssl_server_credentials_create_options_using_config_fetcher(
              clients_have_certificates ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                                        : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE,
              &Fetch, certificates_.get()));
    }
    if (auth_ != nullptr) {
      grpc_server_credentials_set_auth_metadata_processor(
          credentials_, {.process = &Check, .destroy = [](void*) {}, .state = auth_.get()});
    }
  }
  ~Credentials() override { grpc_server_credentials_release(credentials_); }
  Credentials(const Credentials&) = delete;
  Credentials& operator=(const Credentials&) = delete;

  // Nobody may replace the check.
  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>& /*processor*/) override {}

 private:
  static grpc_ssl_certificate_config_reload_status Fetch(void* certificates,
                                                         grpc_ssl_server_certificate_config** config) {
    return static_cast<Certificates*>(certificates)->Fetch(config);
  }

  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }

  const std::unique_ptr<Certificates> certificates_;  // Null without TLS.
  const std::shared_ptr<Auth> auth_;
  grpc_server_credentials* credentials_ = nullptr;
};

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> MakeCredentials(const TlsPaths& paths,
                                                                         std::shared_ptr<Auth> auth, const Log& log) {
  std::unique_ptr<Certificates> certificates;
  if (!paths.certificate.empty()) {
    certificates = std::make_unique<Certificates>(paths, log);
    if (absl::Status loaded = certificates->Load(); !loaded.ok()) return loaded;
  }
  return std::make_shared<Credentials>(std::move(certificates), !paths.client_ca.empty(), std::move(auth));
}

}  // namespace ricochet::server
