#include <CLI/App.hpp>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/cli/explore/connect.h"
#include "client/cli/explore/impact_page.h"
#include "client/cli/explore/web_server.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/program.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/text/json_text.h"
#include "client/cli/text/number_input.h"
#include "client/cost_reader.h"
#include "client/server_address.h"
#include "core/base/try.h"
#include "proto/wire/cost.h"

namespace ricochet::cli {
namespace {

constexpr char kExample[] =
    R"(Example: a page to drag friction, geometry and velocity, until Ctrl-C. It opens no browser.
  $ ricochet explore
  http://127.0.0.1:40719/?token=4f6f1c...
The same address answers the calls of the service as HTTP with JSON, to whoever knows the token (docs/page.md):
  $ curl -H "Authorization: Bearer 4f6f1c..." --json @request.json \
      http://127.0.0.1:40719/ricochet.v1.ImpactService/Solve
Exit codes: 0 done, 2 wrong input, 42 failed, 75 try again.)";

struct ExploreOptions {
  CommonOptions common;
  SceneOptions scene;
  std::string listen = "127.0.0.1:0";
  bool insecure = false;
};

// Splits --listen into a host and a port.
absl::StatusOr<std::pair<std::string, int>> ReadListen(const ExploreOptions& options) {
  const size_t colon = options.listen.rfind(':');
  int port = 0;
  const bool has_port = colon != std::string::npos && absl::SimpleAtoi(options.listen.substr(colon + 1), &port);
  if (!has_port || colon == 0 || port < 0 || port > 65535) {
    return InputError("--listen", options.listen,
                      "be ADDRESS:PORT with a port from 0 to 65535; 0 lets the system choose");
  }
  const std::string host = options.listen.substr(0, colon);
  if (IsLoopbackAddress(options.listen) || options.insecure) {
    return std::pair(host == "localhost" ? "127.0.0.1" : host, port);
  }
  return InputError("--listen", options.listen,
                    "be an address of loopback without --insecure; other hosts could read the token on its way");
}

void AnswerPage(const std::optional<Scene>& scene, Exchange& exchange) {
  if (exchange.method() != "GET" && exchange.method() != "HEAD") {
    return exchange.Reply(405, "text/plain", "must be GET or HEAD\n", "Allow: GET, HEAD\r\n");
  }
  const std::string nonce = RandomHex();
  exchange.Reply(200, "text/html; charset=utf-8", LivePage(scene, nonce),
                 absl::StrCat("Content-Security-Policy: default-src 'none'; script-src 'nonce-", nonce,
                              "'; style-src 'nonce-", nonce, "'; connect-src 'self'; img-src data:; base-uri 'none'; ",
                              "form-action 'none'; frame-ancestors 'none'\r\n"));
}

// Answers a CostRequest in JSON with the whole study.
absl::StatusOr<std::string> CostAnswer(const Solver& solver, const std::string& body, const CallOptions& options) {
  v1::CostRequest request;
  if (absl::Status wrong = ParseJson("the body", body, request); !wrong.ok()) return wrong;
  RICOCHET_TRY(const CostChunk study, WholeStudy(solver.Cost(FromProto(request), options), [](const CostChunk&) {}));
  return JsonOf(ToProto(study));
}

absl::Status RunExplore(const ExploreOptions& options) {
  RICOCHET_TRY(const auto address, ReadListen(options));
  std::optional<Scene> scene;
  if (options.scene.any()) {
    RICOCHET_TRY(scene, ReadScene(options.scene));
  }
  // This comes before the solver and the server, which start threads.
  const Interrupt interrupt;
  RICOCHET_TRY(const std::unique_ptr<Solver> solver, MakeSolver(options.common, {}, Limits()));
  const auto answer = [&](Exchange& exchange, const absl::Status& allowed) {
    if (!allowed.ok()) return ReplyError(allowed, exchange);
    if (exchange.path() == "/") return AnswerPage(scene, exchange);
    JsonCall call = FindCall(*solver, absl::StripPrefix(exchange.path(), "/ricochet.v1.ImpactService/"));
    if (exchange.path() == "/answers") call = std::bind_front(PageAnswers, std::cref(*solver));
    if (exchange.path() == "/cost") call = std::bind_front(CostAnswer, std::cref(*solver));
    AnswerPost(call, interrupt.token(), exchange);
  };
  RICOCHET_TRY(const std::unique_ptr<WebServer> web, WebServer::Start(address.first, address.second, answer));
  std::printf("%s\n", web->url().c_str());
  std::fflush(stdout);
  Interrupt::Wait();
  return absl::OkStatus();
}

}  // namespace

void AddExplore(CLI::App& app, Command& command) {
  const auto [sub, options] = AddCommand<ExploreOptions>(
      app, "explore", "A page to explore an impact, and the service as HTTP with JSON", kExample, RunExplore, command);
  AddSceneOptions(*sub, options->scene);
  sub->add_option("--listen", options->listen,
                  absl::StrCat("Where to serve; port 0 lets the system choose [", options->listen, "]"))
      ->type_name("ADDRESS:PORT");
  sub->add_flag("--insecure", options->insecure,
                "Allow an address that other hosts can reach; nothing is encrypted, not even the token");
  AddConnectionOptions(*sub, options->common.connection);
}

}  // namespace ricochet::cli
