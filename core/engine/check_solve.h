// CheckSolve: the rules of a request for one impact beyond those of its scene.

#ifndef RICOCHET_CORE_ENGINE_CHECK_SOLVE_H_
#define RICOCHET_CORE_ENGINE_CHECK_SOLVE_H_

#include <optional>
#include <vector>

#include "core/contact/scene_contact.h"
#include "core/plan/demand.h"
#include "ricochet/error.h"
#include "ricochet/solver.h"

namespace ricochet {

// The demand of the request. A history of forces requires an impact that takes time.
Demand DemandOf(const SolveRequest& request);

// Lists what is wrong with the request whatever its scene, which may break its own rules.
std::vector<Violation> CheckSolve(const SolveRequest& request);

// Lists every rule that the request breaks; its scene must be valid. `contact` is as for CheckDemand.
std::vector<Violation> CheckSolve(const SolveRequest& request, std::optional<SceneContact>& contact);

// Adds the violations of a certificate with `digits`; 0 asks for none.
void CheckDigits(const Scene& scene, int digits, std::vector<Violation>& violations);

}  // namespace ricochet

#endif  // RICOCHET_CORE_ENGINE_CHECK_SOLVE_H_
