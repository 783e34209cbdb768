// TlsFiles: the certificate, the key and the clients' authorities of a server, read again when their files change.

#ifndef RICOCHET_SERVER_SECURITY_TLS_FILES_H_
#define RICOCHET_SERVER_SECURITY_TLS_FILES_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/base/log.h"
#include "server/base/watched_file.h"

namespace ricochet::server {

// The paths of files in PEM form.
struct TlsPaths {
  std::string certificate;  // The server's certificate and those between it and its authority; empty: no TLS.
  std::string key;          // The private key of the certificate, without a pass phrase.
  std::string client_ca;    // The authorities whose clients are let in; empty: clients need no certificate.

  friend bool operator==(const TlsPaths&, const TlsPaths&) = default;
};

// The contents of the files.
struct TlsContents {
  std::string certificate;
  std::string key;
  std::string client_ca;
};

// Thread safety: for one thread at a time.
class TlsFiles {
 public:
  explicit TlsFiles(const TlsPaths& paths);

  // Returns true if a file has changed since Read.
  bool HaveChanged() const;

  // Reads all files and checks that they fit together.
  // Errors: those of the file system, INVALID_ARGUMENT that names the file and what it should hold.
  absl::StatusOr<TlsContents> Read();

 private:
  WatchedFile certificate_;
  WatchedFile key_;
  std::optional<WatchedFile> client_ca_;
};

// Returns the fields of a log line about a certificate in PEM form: its subject and the time at which it ends.
std::vector<LogField> DescribeCertificate(const std::string& pem);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SECURITY_TLS_FILES_H_
