// The subcommand audit: what observed impacts imply, and which limits they break.

#ifndef RICOCHET_CLIENT_CLI_AUDIT_H_
#define RICOCHET_CLIENT_CLI_AUDIT_H_

#include "client/cli/common.h"

namespace ricochet::cli {

void AddAudit(CLI::App& app, Command& command);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_AUDIT_H_
