#include "client/cli/input/demand_input.h"

#include <CLI/App.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/input/command_options.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/number_input.h"
#include "core/base/nearest.h"
#include "core/base/try.h"

namespace ricochet::cli {
namespace {

std::vector<std::string> EffectWords() {
  std::vector<std::string> words;
  for (int i = 1; i < kEffectCount; ++i) words.push_back(EffectWord(static_cast<Effect>(i)));
  return words;
}

absl::StatusOr<std::vector<Effect>> ReadEffects(const std::vector<std::string>& words, const char* flag) {
  const std::vector<std::string> known = EffectWords();
  std::vector<Effect> effects;
  for (const std::string& word : words) {
    size_t i = 0;
    while (i < known.size() && known[i] != word) ++i;
    if (i == known.size())
      return InputError(flag, word, absl::StrCat("be one of ", absl::StrJoin(known, ", "), DidYouMean(word, known)));
    effects.push_back(static_cast<Effect>(i + 1));
  }
  return effects;
}

}  // namespace

void AddDemandOptions(CLI::App& app, DemandOptions& options) {
  const std::string group = "Accuracy and effects";
  app.add_option("--tolerance", options.tolerance,
                 "Largest relative error of the contact velocity after the impact; effects that provably change less "
                 "are left out [1e-12]")
      ->type_name("X")
      ->group(group);
  AddList(app, "--require", options.required, "Effects that are simulated even if they are negligible")
      ->type_name("EFFECT,...")
      ->group(group);
  AddList(app, "--exclude", options.excluded, "Effects that are left out whatever that changes")
      ->type_name("EFFECT,...")
      ->group(group);
}

absl::StatusOr<DemandFields> ReadDemand(const DemandOptions& options) {
  DemandFields demand;
  if (!options.tolerance.empty()) {
    RICOCHET_TRY(demand.relative_tolerance, ParseNumber(options.tolerance, "--tolerance"));
  }
  RICOCHET_TRY(std::vector<Effect> required, ReadEffects(options.required, "--require"));
  RICOCHET_TRY(std::vector<Effect> excluded, ReadEffects(options.excluded, "--exclude"));
  demand.required = std::move(required);
  demand.excluded = std::move(excluded);
  return demand;
}

}  // namespace ricochet::cli
