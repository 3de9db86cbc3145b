// The subcommands. Each adds itself to the command line and puts what it ended with into *exit_code when it was chosen.
#ifndef LACERTA_CLI_COMMANDS_H_
#define LACERTA_CLI_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <limits>
#include <string>

namespace lacerta::cli {

// For numbers above 0. CLI11's own names the largest number that there is where a word is none.
inline const CLI::Validator& Positive() {
  static const CLI::Validator* const kPositive = new CLI::Validator(
      [](const std::string& word) {
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        const bool is_number = end != word.c_str() && *end == '\0' && value > 0.0 && value <= std::numeric_limits<double>::max();
        return is_number ? std::string() : "has to be a number above 0, not \"" + word + "\"";
      },
      "POSITIVE");
  return *kPositive;
}

void AddPackCommand(CLI::App* app, int* exit_code);
void AddUnpackCommand(CLI::App* app, int* exit_code);
void AddInfoCommand(CLI::App* app, int* exit_code);
void AddCompareCommand(CLI::App* app, int* exit_code);
void AddTrimCommand(CLI::App* app, int* exit_code);
void AddValidateCommand(CLI::App* app, int* exit_code);

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_COMMANDS_H_
