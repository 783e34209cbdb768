// Callers: who may call which methods, read from the file of --tokens.
//
//   # name    how it proves who it is   scopes
//   lab       sha256:<64 hex digits>    solve,sweep
//   monitor   certificate               info
//
// A token is known by its hash only. It must be random, with 128 bits or more: a hash of a password could be guessed.
// Two lines may have one name, so that an old and a new token hold side by side while clients change over. No two lines
// have one token or one certificate, because only one of them could count.

#ifndef RICOCHET_SERVER_SECURITY_CALLERS_H_
#define RICOCHET_SERVER_SECURITY_CALLERS_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace ricochet::server {

class Callers {
 public:
  struct Caller {
    std::string name;                 // "token:lab" or "certificate:monitor".
    std::vector<std::string> scopes;  // Among Scopes().
  };

  // Reads the lines of a file.
  // Errors: INVALID_ARGUMENT that names every wrong line and what would be right; or that no line names a caller.
  static absl::StatusOr<Callers> Parse(const std::string& text);

  // Returns the caller who has this token, in a time that does not depend on how much of a hash is right.
  std::optional<Caller> WithToken(const std::string& token) const;

  // Returns the caller whose certificate was issued to this name.
  std::optional<Caller> WithCertificate(const std::string& name) const;

 private:
  using Hash = std::array<unsigned char, 32>;
  struct Line {
    std::optional<Hash> token;  // Absent: the caller has a certificate.
    std::string name;
    std::vector<std::string> scopes;
  };
  static absl::StatusOr<Line> ParseLine(const std::string& text);

  std::vector<Line> lines_;
};

// Returns every scope that a caller can have: "audit", "cost", "info", "solve", "sweep" and, for all of them, "all".
std::vector<std::string> Scopes();

// Returns the scope that a call needs, by the path of its method ("/ricochet.v1.ImpactService/Solve"): an empty text if
// everybody may call it, as health; nothing if nobody may.
std::optional<std::string> ScopeOf(const std::string& method);

}  // namespace ricochet::server

#endif  // RICOCHET_SERVER_SECURITY_CALLERS_H_
