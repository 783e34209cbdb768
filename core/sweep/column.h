// Columns: the numbers of an Outcome that a sweep can ask for, by path.

#ifndef RICOCHET_CORE_SWEEP_COLUMN_H_
#define RICOCHET_CORE_SWEEP_COLUMN_H_

#include <string>
#include <unordered_map>
#include <vector>

#include "ricochet/error.h"
#include "ricochet/outcome.h"
#include "ricochet/scene.h"

namespace ricochet {

// Lists every column of a sweep over the scene, as ricochet.v1.Outcome spells it: "coefficients.newton",
// "rates_after_rad_s[0]". The list depends on the system: its links, its bodies, plane or space.
std::vector<std::string> Columns(const Scene& scene);

// The position of each column in the list of all, by its name.
using ColumnPositions = std::unordered_map<std::string, size_t>;
ColumnPositions PositionsOf(const std::vector<std::string>& columns);

// Lists what is wrong with the columns that a request names: there must be at least one, each known and named once.
std::vector<Violation> CheckColumns(const std::vector<std::string>& columns, const std::vector<std::string>& all,
                                    const ColumnPositions& known);

// Replaces `numbers` by the number behind each of Columns(scene), in that order, for an outcome of that scene.
void ReadColumns(const Outcome& outcome, std::vector<double>& numbers);

}  // namespace ricochet

#endif  // RICOCHET_CORE_SWEEP_COLUMN_H_
