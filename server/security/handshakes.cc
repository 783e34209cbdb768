#include "server/security/handshakes.h"

#include <openssl/bio.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/base/log.h"

namespace ricochet::server {
namespace {

// This is kept with an SSL object until it is freed.
struct Handshake {
  std::string peer;
  std::string alert;
};

thread_local std::string current_peer;

Handshake* Find(const SSL* ssl);

void OnMessage(int is_sent, int /*version*/, int type, const void* bytes, size_t size, SSL* ssl, void* /*unused*/) {
  Handshake* const handshake = Find(ssl);
  if (handshake == nullptr || type != SSL3_RT_ALERT || size != 2) return;
  const int description = static_cast<const unsigned char*>(bytes)[1];
  // OpenSSL has no name for this one of TLS 1.3.
  const char* const name =
      description == SSL_AD_CERTIFICATE_REQUIRED ? "certificate required" : SSL_alert_desc_string_long(description);
  handshake->alert = absl::StrCat(is_sent != 0 ? "alert to the client: " : "alert by the client: ", name);
}

void OnNew(void* object, void* /*before*/, CRYPTO_EX_DATA* data, int index, long /*unused*/, void* /*unused*/) {
  if (current_peer.empty()) return;
  CRYPTO_set_ex_data(data, index, new Handshake{.peer = current_peer, .alert = ""});
  SSL_set_msg_callback(static_cast<SSL*>(object), &OnMessage);
}

std::string ReasonOf(const SSL* ssl, const Handshake& handshake) {
  if (const long verified = SSL_get_verify_result(ssl); verified != X509_V_OK) {
    return absl::StrCat("certificate of the client: ", X509_verify_cert_error_string(verified));
  }
  if (!handshake.alert.empty()) return handshake.alert;
  return absl::StrCat("the connection ended at ", SSL_state_string_long(ssl));
}

void OnFree(void* object, void* kept, CRYPTO_EX_DATA* /*data*/, int /*index*/, long /*unused*/, void* /*unused*/) {
  const std::unique_ptr<Handshake> handshake(static_cast<Handshake*>(kept));
  const auto* const ssl = static_cast<const SSL*>(object);
  if (handshake == nullptr || SSL_is_init_finished(ssl) != 0) return;
  const bool is_probe = SSL_get_rbio(ssl) == nullptr || BIO_number_read(SSL_get_rbio(ssl)) == 0;
  Log::WriteForGrpc(is_probe ? LogLevel::kDebug : LogLevel::kWarning, "handshake failed",
                    {{"peer", handshake->peer}, {"reason", is_probe ? "nothing was sent" : ReasonOf(ssl, *handshake)}});
}

int Index() {
  static const int index = CRYPTO_get_ex_new_index(CRYPTO_EX_INDEX_SSL, 0, nullptr, &OnNew, nullptr, &OnFree);
  return index;
}

Handshake* Find(const SSL* ssl) { return static_cast<Handshake*>(SSL_get_ex_data(ssl, Index())); }

}  // namespace

HandshakesOf::HandshakesOf(std::string peer) {
  static_cast<void>(Index());
  current_peer = std::move(peer);
}

HandshakesOf::~HandshakesOf() { current_peer.clear(); }

}  // namespace ricochet::server
