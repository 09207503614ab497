#include "tools/command/program.h"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <utility>

#include "tools/command/terminal.h"
#include "tools/command/usage_text.h"

namespace maploop::tools {
namespace {

// Whether everything that was printed has arrived at its terminal, file or pipe.
bool printed_all() {
  const bool flushed = std::fflush(stdout) == 0;
  return std::cout.flush() && flushed && std::ferror(stdout) == 0;
}

}  // namespace

int run(const Program& program, int argc, char** argv) {
  CLI::App app{"maploop: vehicle localization in real time", program.name};
  app.require_subcommand(1);
  app.formatter_fn(
      [usual = CLI::Formatter()](const CLI::App* of, std::string name, CLI::AppFormatMode mode) {
        return wrapped(usual.make_help(of, std::move(name), mode), columns_of(STDOUT_FILENO));
      });
  app.footer(
      "Pages that a help text names are in the source tree, and below share/doc/maploop where "
      "maploop is installed.");
  app.set_version_flag("--version", program.version);
  Command command;
  for (AddCommand* add : program.commands) add(app, command);
  try {
    app.parse(argc, argv);
    const int status = command();
    if (printed_all()) return status;
    std::cerr << "maploop: standard output was not taken: it is closed, or its disk is full\n";
    return status != 0 ? status : 1;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::cerr << usage_error(app, e);
    return exit_usage;
  } catch (const std::bad_alloc&) {
    std::cerr << "maploop: this machine has too little memory for what was asked\n";
    return 1;
  } catch (const std::exception& e) {
    std::cerr << "maploop: " << e.what() << '\n';
    return 1;
  }
}

}  // namespace maploop::tools
