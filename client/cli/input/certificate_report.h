// The option --certified, and the report of a certificate as text and as CSV.

#ifndef RICOCHET_CLIENT_CLI_INPUT_CERTIFICATE_REPORT_H_
#define RICOCHET_CLIENT_CLI_INPUT_CERTIFICATE_REPORT_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "ricochet/certificate.h"

namespace ricochet::cli {

void AddCertifiedOption(CLI::App& sub, std::string& digits);

// Returns the number of digits, or 0 if the option is not given. Errors: INVALID_ARGUMENT outside [1,
// kMostCertifiedDigits].
absl::StatusOr<int32_t> ReadCertifiedDigits(const std::string& digits);

// Returns one line for each number: its path and its digits, or the range that is proved to contain it.
std::string CertificateText(const Certificate& certificate);

// Returns a header and one row for each number.
std::string CertificateCsv(const Certificate& certificate);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_INPUT_CERTIFICATE_REPORT_H_
