// Certificates and private keys in PEM form, as OpenSSL reads them.

#ifndef RICOCHET_PROTO_WIRE_PEM_H_
#define RICOCHET_PROTO_WIRE_PEM_H_

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <memory>
#include <string>

namespace ricochet::pem {

template <auto function>
struct Free {
  template <typename Object>
  void operator()(Object* object) const {
    function(object);
  }
};
using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;

inline Bio BioOf(const std::string& text) { return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))); }

// Otherwise OpenSSL would ask for a pass phrase at the terminal.
inline int NoPassPhrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return -1; }

// Both return null if the text holds nothing of the kind, or a key with a pass phrase. gRPC would take what OpenSSL
// notes of a failure for an error of its own, so that it is cleared.
inline Certificate ParseCertificate(const std::string& text) {
  Certificate certificate(PEM_read_bio_X509(BioOf(text).get(), nullptr, NoPassPhrase, nullptr));
  ERR_clear_error();
  return certificate;
}

inline Key ParseKey(const std::string& text) {
  Key key(PEM_read_bio_PrivateKey(BioOf(text).get(), nullptr, NoPassPhrase, nullptr));
  ERR_clear_error();
  return key;
}

}  // namespace ricochet::pem

#endif  // RICOCHET_PROTO_WIRE_PEM_H_
