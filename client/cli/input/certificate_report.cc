#include "client/cli/input/certificate_report.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/text/enum_names.h"
#include "client/cli/text/number_input.h"
#include "core/base/counted.h"
#include "core/base/decimal.h"
#include "core/base/try.h"

namespace ricochet::cli {

void AddCertifiedOption(CLI::App& sub, std::string& digits) {
  sub.add_option("--certified", digits, "Also numbers with this many proved significant digits, 1 to 1000")
      ->type_name("DIGITS");
}

absl::StatusOr<int32_t> ReadCertifiedDigits(const std::string& digits) {
  if (digits.empty()) return 0;
  RICOCHET_TRY(const int64_t count, ParseCount(digits, "--certified", kMostCertifiedDigits));
  return static_cast<int32_t>(count);
}

std::string CertificateText(const Certificate& certificate) {
  const std::string regimes = absl::StrJoin(
      certificate.regimes, ", or ", [](std::string* out, Regime regime) { absl::StrAppend(out, RegimeText(regime)); });
  size_t width = 0;
  for (const CertifiedNumber& number : certificate.numbers) width = std::max(width, number.path.size());
  std::string text =
      absl::StrCat("\nProved to ", Counted(certificate.digits, "digit"),
                   certificate.is_set ? ", some numbers as ranges: " : ": ", regimes, " (= marks exact values)\n");
  for (const CertifiedNumber& number : certificate.numbers) {
    const char* const relation = number.decimal.empty() ? "in" : number.exact ? "= " : "  ";
    const std::string value =
        number.decimal.empty() ? absl::StrCat("[", number.lower, ", ", number.upper, "]") : number.decimal;
    absl::StrAppend(&text, "  ", number.path, std::string(width + 2 - number.path.size(), ' '), relation, " ", value,
                    "\n");
  }
  return text;
}

std::string CertificateCsv(const Certificate& certificate) {
  std::string text = "path,decimal,lower,upper,value,exact\n";
  for (const CertifiedNumber& number : certificate.numbers) {
    absl::StrAppend(&text, number.path, ",", number.decimal, ",", number.lower, ",", number.upper, ",",
                    ShortestDecimal(number.value), ",", number.exact ? "true" : "false", "\n");
  }
  return text;
}

}  // namespace ricochet::cli
