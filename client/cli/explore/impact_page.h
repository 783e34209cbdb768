// ImpactPage: one impact as an HTML page, in the pictures of impact_page.html.
//
// The page either asks an engine over HTTP, or has its answers in itself and needs nothing beside it. What differs is
// the JSON text that takes the place of {{start}} in the file: the scenes to start from, the scene if there is one, and
// the answers of a page that asks nobody. {{nonce}} stands for the nonce that the content security policy demands of
// its style and its script.

#ifndef RICOCHET_CLIENT_CLI_EXPLORE_IMPACT_PAGE_H_
#define RICOCHET_CLIENT_CLI_EXPLORE_IMPACT_PAGE_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "ricochet/solver.h"

namespace ricochet::cli {

// Returns a page that asks the engine from which it was loaded, and starts from `scene` if there is one.
std::string LivePage(const std::optional<Scene>& scene, const std::string& nonce);

// Returns a page that holds `response`, and what `solver` answers to the other questions of the page.
std::string FinishedPage(const Solver& solver, const SolveRequest& request, const SolveResponse& response);

// Answers the page: `body` is a SolveRequest in JSON. Returns {"solve": {"request": ..., "answer": ...}, ...} with what
// `solver` answers to each question of the page, or an "error" in place of an answer. Errors: those of Solve.
absl::StatusOr<std::string> PageAnswers(const Solver& solver, const std::string& body, const CallOptions& options);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_EXPLORE_IMPACT_PAGE_H_
