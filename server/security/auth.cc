#include "server/security/auth.h"

#include <grpcpp/security/auth_context.h>

#include <algorithm>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/base/request_id.h"
#include "server/base/telemetry_names.h"
#include "server/security/peer.h"

namespace ricochet::server {
namespace {

constexpr std::chrono::seconds kBetweenLooks(1);

// A longer token is refused before it is hashed.
constexpr size_t kMostTokenBytes = 512;

constexpr char kBearer[] = "Bearer ";

std::string Text(const grpc::string_ref& text) { return {text.data(), text.size()}; }

Evidence EvidenceOf(const grpc::ServerContext& context) {
  Evidence evidence;
  const auto headers = context.client_metadata().equal_range("authorization");
  for (auto header = headers.first; header != headers.second; ++header) {
    evidence.authorization.push_back(Text(header->second));
  }
  if (const auto auth = context.auth_context(); auth != nullptr) evidence.certificate_names = CertificateNames(*auth);
  return evidence;
}

bool MayCall(const Callers::Caller& caller, const std::optional<std::string>& scope) {
  const auto allows = [&scope](const std::string& one) { return one == "all" || one == scope; };
  return scope.has_value() && std::any_of(caller.scopes.begin(), caller.scopes.end(), allows);
}

}  // namespace

absl::StatusOr<std::shared_ptr<Auth>> Auth::Open(const std::string& path, const Log& log) {
  std::shared_ptr<Auth> auth(new Auth(path, log));
  const std::lock_guard lock(auth->mutex_);
  if (absl::Status loaded = auth->Load(); !loaded.ok()) return loaded;
  return auth;
}

absl::Status Auth::Load() {
  const absl::StatusOr<std::string> text = file_.Read();
  if (!text.ok()) return text.status();
  absl::StatusOr<Callers> callers = Callers::Parse(*text);
  if (!callers.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(file_.path(), ": ", callers.status().message()));
  }
  callers_ = std::make_shared<const Callers>(*std::move(callers));
  return absl::OkStatus();
}

std::shared_ptr<const Callers> Auth::Current() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (now >= next_look_) {
    next_look_ = now + kBetweenLooks;
    if (file_.HasChanged()) {
      const absl::Status loaded = Load();
      if (loaded.ok()) {
        log_.Write(LogLevel::kInfo, "tokens read", {{"file", file_.path()}});
      } else {
        log_.Write(LogLevel::kError, "tokens not read",
                   {{"file", file_.path()}, {"reason", std::string(loaded.message())}});
      }
    }
  }
  return callers_;
}

Auth::Finding Auth::Find(const Evidence& evidence) {
  const std::shared_ptr<const Callers> callers = Current();
  if (evidence.authorization.size() > 1) return {.caller = std::nullopt, .reason = "several authorization headers"};
  if (!evidence.authorization.empty()) {
    const std::string& header = evidence.authorization.front();
    if (!absl::StartsWithIgnoreCase(header, kBearer)) return {.caller = std::nullopt, .reason = "not a bearer token"};
    const std::string token = header.substr(sizeof(kBearer) - 1);
    if (token.size() > kMostTokenBytes) return {.caller = std::nullopt, .reason = "token too long"};
    return {.caller = callers->WithToken(token), .reason = "unknown token"};
  }
  for (const std::string& name : evidence.certificate_names) {
    if (auto caller = callers->WithCertificate(name); caller.has_value()) return {.caller = caller, .reason = ""};
  }
  return {.caller = std::nullopt,
          .reason = evidence.certificate_names.empty() ? "no token" : "no token, and no line for the certificate"};
}

absl::Status Auth::Check(const Evidence& evidence) {
  const std::optional<std::string> scope = ScopeOf(evidence.method);
  if (scope.has_value() && scope->empty()) return absl::OkStatus();
  const Finding finding = Find(evidence);
  if (!finding.caller.has_value()) {
    return Refuse(absl::UnauthenticatedError("the call is not authenticated"), evidence, "", finding.reason);
  }
  if (MayCall(*finding.caller, scope)) return absl::OkStatus();
  return Refuse(absl::PermissionDeniedError("the caller may not call this method"), evidence, finding.caller->name,
                scope.has_value() ? absl::StrCat("scope ", *scope, " is missing") : "unknown method");
}

bool Auth::StillAllows(const grpc::ServerContext& context, const std::string& method, const std::string& caller) {
  const std::optional<Callers::Caller> found = Find(EvidenceOf(context)).caller;
  return found.has_value() && found->name == caller && MayCall(*found, ScopeOf(method));
}

std::string Auth::CallerOf(const grpc::ServerContext& context) {
  const Finding finding = Find(EvidenceOf(context));
  return finding.caller.has_value() ? finding.caller->name : "";
}

absl::Status Auth::Refuse(absl::Status refusal, const Evidence& evidence, const std::string& caller,
                          const std::string& why) const {
  count_(absl::IsUnauthenticated(refusal) ? kUnauthenticatedReason : kPermissionDeniedReason);
  log_.Write(LogLevel::kWarning, "call refused",
             {{"method", evidence.method},
              {"status", absl::StatusCodeToString(refusal.code())},
              {"request_id", RequestIdOr(evidence.request_id)},
              {"caller", caller},
              {"certificate", absl::StrJoin(evidence.certificate_names, ",")},
              {"user_agent", Clipped(evidence.user_agent)},
              {"reason", why}});
  return refusal;
}

}  // namespace ricochet::server
