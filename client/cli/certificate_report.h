// The option --certified, and a certificate as text and as CSV.

#ifndef RICOCHET_CLIENT_CLI_CERTIFICATE_REPORT_H_
#define RICOCHET_CLIENT_CLI_CERTIFICATE_REPORT_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "ricochet/certificate.h"

namespace ricochet::cli {

void AddCertifiedOption(CLI::App& sub, std::string& digits);

// 0 where the option is not given.
absl::StatusOr<int32_t> ReadCertifiedDigits(const std::string& digits);

// A line a number: its path and its digits, or the range that it is proved to lie in.
std::string CertificateText(const Certificate& certificate);

// One row a number.
std::string CertificateCsv(const Certificate& certificate);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_CERTIFICATE_REPORT_H_
