// ResumeCommand: the command line that goes on with an unfinished sweep.

#ifndef RICOCHET_CLIENT_CLI_SWEEP_RESUME_COMMAND_H_
#define RICOCHET_CLIENT_CLI_SWEEP_RESUME_COMMAND_H_

#include <string>
#include <vector>

namespace ricochet::cli {

// Returns `arguments`, the name of the program first, with --resume, quoted for a shell.
std::string ResumeCommand(const std::vector<std::string>& arguments);

}  // namespace ricochet::cli

#endif  // RICOCHET_CLIENT_CLI_SWEEP_RESUME_COMMAND_H_
