#include "server/security/callers.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"

namespace ricochet::server {
namespace {

constexpr char kService[] = "/ricochet.v1.ImpactService/";
constexpr char kAll[] = "all";
constexpr char kCertificate[] = "certificate";

// The scope of each method of the service.
const std::map<std::string, std::string>& MethodScopes() {
  static const std::map<std::string, std::string> scopes = {
      {"Solve", "solve"}, {"SolveBatch", "solve"},   {"Plan", "solve"},         {"Bounds", "solve"},
      {"Audit", "audit"}, {"AuditBatch", "audit"},   {"Sweep", "sweep"},        {"Cost", "cost"},
      {"Info", "info"},   {"SolveBatches", "solve"}, {"MultiContact", "solve"}, {"Fit", "audit"},
  };
  return scopes;
}

bool IsScope(const std::string& text) {
  const std::vector<std::string> scopes = Scopes();
  return std::find(scopes.begin(), scopes.end(), text) != scopes.end();
}

absl::Status BrokenLine() {
  return absl::InvalidArgumentError(
      absl::StrCat("must be NAME sha256:<64 hex digits>|certificate SCOPE[,SCOPE...], with scopes from ",
                   absl::StrJoin(Scopes(), ", ")));
}

}  // namespace

std::vector<std::string> Scopes() {
  std::set<std::string> scopes;
  for (const auto& [method, scope] : MethodScopes()) scopes.insert(scope);
  std::vector<std::string> all(scopes.begin(), scopes.end());
  all.emplace_back(kAll);
  return all;
}

std::optional<std::string> ScopeOf(const std::string& method) {
  if (absl::StartsWith(method, "/grpc.health.v1.Health/")) return "";
  if (absl::StartsWith(method, "/grpc.reflection.")) return "info";
  if (!absl::StartsWith(method, kService)) return std::nullopt;
  const auto found = MethodScopes().find(std::string(absl::StripPrefix(method, kService)));
  return found == MethodScopes().end() ? std::nullopt : std::optional(found->second);
}

absl::StatusOr<Callers::Line> Callers::ParseLine(const std::string& text) {
  const std::vector<std::string> words = absl::StrSplit(text, absl::ByAnyChar(" \t\r"), absl::SkipEmpty());
  if (words.size() != 3) return BrokenLine();
  Line line = {.name = words[0], .scopes = absl::StrSplit(words[2], ',')};
  if (!std::all_of(line.scopes.begin(), line.scopes.end(), IsScope)) return BrokenLine();
  if (words[1] == kCertificate) return line;
  const std::string digits(absl::StripPrefix(words[1], "sha256:"));
  const bool hexadecimal =
      std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return absl::ascii_isxdigit(c); });
  if (digits == words[1] || digits.size() != 2 * sizeof(Hash) || !hexadecimal) {
    return BrokenLine();
  }
  const std::string bytes = absl::HexStringToBytes(digits);
  std::copy(bytes.begin(), bytes.end(), line.token.emplace().begin());
  return line;
}

absl::StatusOr<Callers> Callers::Parse(const std::string& text) {
  Callers callers;
  std::map<std::pair<std::optional<Hash>, std::string>, int> proofs;  // The line of each token and certificate.
  std::vector<std::string> wrong;
  int number = 0;
  for (const auto part : absl::StrSplit(text, '\n')) {
    ++number;
    const std::string line(absl::StripAsciiWhitespace(part));
    if (line.empty() || line.front() == '#') continue;
    absl::StatusOr<Line> parsed = ParseLine(line);
    // The line itself is not shown, as it may hold a token by mistake.
    if (!parsed.ok()) {
      wrong.push_back(absl::StrCat("line ", number, " ", parsed.status().message()));
      continue;
    }
    const auto [first, is_new] = proofs.try_emplace({parsed->token, parsed->token ? "" : parsed->name}, number);
    if (!is_new) {
      const char* const proof = parsed->token ? "token" : "certificate";
      wrong.push_back(absl::StrCat("line ", number, " must have another ", proof, " than line ", first->second));
    }
    callers.lines_.push_back(*std::move(parsed));
  }
  if (!wrong.empty()) return absl::InvalidArgumentError(absl::StrJoin(wrong, "; "));
  if (callers.lines_.empty()) return absl::InvalidArgumentError("no line names a caller");
  return callers;
}

std::optional<Callers::Caller> Callers::WithToken(const std::string& token) const {
  Hash hash = {};
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(), hash.data());
  const Line* found = nullptr;
  for (const Line& line : lines_) {
    if (line.token.has_value() && CRYPTO_memcmp(line.token->data(), hash.data(), hash.size()) == 0) found = &line;
  }
  if (found == nullptr) return std::nullopt;
  return Caller{.name = "token:" + found->name, .scopes = found->scopes};
}

std::optional<Callers::Caller> Callers::WithCertificate(const std::string& name) const {
  for (const Line& line : lines_) {
    if (!line.token.has_value() && line.name == name) {
      return Caller{.name = "certificate:" + name, .scopes = line.scopes};
    }
  }
  return std::nullopt;
}

}  // namespace ricochet::server
