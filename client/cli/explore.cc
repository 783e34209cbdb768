#include <CLI/App.hpp>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/cli/explore/connect.h"
#include "client/cli/explore/impact_page.h"
#include "client/cli/explore/web_server.h"
#include "client/cli/input/make_solver.h"
#include "client/cli/input/scene_input.h"
#include "client/cli/subcommands.h"
#include "client/cli/terminal/interrupt.h"
#include "client/cli/text/number_input.h"
#include "client/server_address.h"

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

// Splits --listen into the host and the port of `server`.
absl::Status ReadListen(const ExploreOptions& options, WebServer::Options& server) {
  const size_t colon = options.listen.rfind(':');
  const bool has_port = colon != std::string::npos && absl::SimpleAtoi(options.listen.substr(colon + 1), &server.port);
  if (!has_port || colon == 0 || server.port < 0 || server.port > 65535) {
    return InputError("--listen", options.listen,
                      "be ADDRESS:PORT with a port from 0 to 65535; 0 lets the system choose");
  }
  server.host = options.listen.substr(0, colon);
  if (server.host == "localhost") server.host = "127.0.0.1";
  if (IsLoopbackAddress(options.listen) || options.insecure) return absl::OkStatus();
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

void WaitFor(const std::stop_token& stop) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any().wait(lock, stop, [] { return false; });
}

absl::Status RunExplore(const ExploreOptions& options) {
  WebServer::Options server = {.host = "", .token = RandomHex(), .answer = nullptr};
  if (absl::Status wrong = ReadListen(options, server); !wrong.ok()) return wrong;
  std::optional<Scene> scene;
  if (options.scene.any()) {
    absl::StatusOr<Scene> read = ReadScene(options.scene);
    if (!read.ok()) return read.status();
    scene = *std::move(read);
  }
  // This comes before the solver and the server, which start threads.
  const Interrupt interrupt;
  const absl::StatusOr<std::unique_ptr<Solver>> solver = MakeSolver(options.common, {}, Limits());
  if (!solver.ok()) return solver.status();
  server.answer = [&](Exchange& exchange, const absl::Status& allowed) {
    if (!allowed.ok()) return ReplyError(allowed, exchange);
    if (exchange.path() == "/") return AnswerPage(scene, exchange);
    AnswerConnect(**solver, interrupt.token(), exchange);
  };
  const std::string token = server.token;
  const absl::StatusOr<std::unique_ptr<WebServer>> web = WebServer::Start(std::move(server));
  if (!web.ok()) return web.status();
  std::printf("http://%s/?token=%s\n", (*web)->authority().c_str(), token.c_str());
  std::fflush(stdout);
  WaitFor(interrupt.token());
  return absl::OkStatus();
}

}  // namespace

void AddExplore(CLI::App& app, Command& command) {
  CLI::App* sub = app.add_subcommand("explore", "A page to explore an impact, and the service as HTTP with JSON");
  const auto options = std::make_shared<ExploreOptions>();
  AddSceneOptions(*sub, options->scene);
  sub->add_option("--listen", options->listen, "Where to serve; port 0 lets the system choose")
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  sub->add_flag("--insecure", options->insecure,
                "Allow an address that other hosts can reach; nothing is encrypted, not even the token");
  AddServerOptions(*sub, options->common);
  sub->footer(kExample);
  sub->callback([options, &command] { command = [options] { return RunExplore(*options); }; });
}

}  // namespace ricochet::cli
