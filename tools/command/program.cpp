#include "tools/command/program.h"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>

#include "tools/command/output_check.h"
#include "tools/command/terminal.h"
#include "tools/command/usage_text.h"

namespace maploop::tools {
namespace {

void say(const std::string& error) {
  std::cerr << in_colour(STDERR_FILENO, "maploop: " + error + '\n');
}

// Whether everything that was printed has arrived at its terminal, file or pipe.
bool printed_all() {
  const bool flushed = std::fflush(stdout) == 0;
  return std::cout.flush() && flushed && std::ferror(stdout) == 0;
}

}  // namespace

int run(const Program& program, int argc, char** argv) {
  CLI::App app{"maploop: vehicle localization in real time", program.name};
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(
      "Pages that a help text names are in the source tree, and below share/doc/maploop where "
      "maploop is installed.");
  app.set_version_flag("--version", program.version);
  Command command;
  for (AddCommand* add : program.commands) add(app, command);
  try {
    app.parse(argc, argv);
    check_outputs(app);
    const int status = command();
    if (printed_all()) return status;
    say("standard output was not taken: it is closed, or its disk is full");
    return status != 0 ? status : 1;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::cerr << in_colour(STDERR_FILENO, usage_error(app, e));
    return exit_usage;
  } catch (const std::bad_alloc&) {
    say("this machine has too little memory for what was asked");
    return 1;
  } catch (const std::exception& e) {
    say(e.what());
    return 1;
  }
}

}  // namespace maploop::tools
