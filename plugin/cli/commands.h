// The subcommands. Each adds itself to the command line and puts what it ended with into *exit_code when it was chosen.
#ifndef LACERTA_CLI_COMMANDS_H_
#define LACERTA_CLI_COMMANDS_H_

#include <CLI/CLI.hpp>

namespace lacerta::cli {

void AddPackCommand(CLI::App* app, int* exit_code);
void AddUnpackCommand(CLI::App* app, int* exit_code);
void AddInfoCommand(CLI::App* app, int* exit_code);
void AddCompareCommand(CLI::App* app, int* exit_code);
void AddTrimCommand(CLI::App* app, int* exit_code);
void AddValidateCommand(CLI::App* app, int* exit_code);

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_COMMANDS_H_
