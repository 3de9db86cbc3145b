#include <exception>
#include <new>

#include "commands.h"
#include "exit_code.h"

int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape): options that cannot be added are a mistake in here
  using namespace lacerta::cli;
  CLI::App app("Progressive, Draco-compatible compression of triangle meshes.", "lacerta");
  app.require_subcommand(1);
  app.footer(kExitCodeHelp);
  app.set_version_flag("--version", LACERTA_VERSION);
  int exit_code = kExitOk;
  AddPackCommand(&app, &exit_code);
  AddUnpackCommand(&app, &exit_code);
  AddInfoCommand(&app, &exit_code);
  AddCompareCommand(&app, &exit_code);
  AddTrimCommand(&app, &exit_code);
  AddValidateCommand(&app, &exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitOk : kExitUsage;
  } catch (const std::bad_alloc&) {
    return Finish(lacerta::LimitExceeded("not enough memory"));
  } catch (const std::exception& error) {
    return Finish(lacerta::InternalError(error.what()));
  }
  return exit_code;
}
