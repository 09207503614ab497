#include <unistd.h>

#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <utility>

#include "tools/command/commands.h"
#include "tools/command/terminal.h"
#include "tools/command/usage_error.h"
#include "tools/command/wrapped_text.h"

namespace {

// What was printed for a person or a pipe has come there.
bool printed_all() {
  const bool flushed = std::fflush(stdout) == 0;
  return std::cout.flush() && flushed && std::ferror(stdout) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"maploop: vehicle localization in real time", "maploop"};
  app.require_subcommand(1);
  app.formatter_fn(
      [usual = CLI::Formatter()](const CLI::App* of, std::string name, CLI::AppFormatMode mode) {
        return maploop::tools::wrapped(usual.make_help(of, std::move(name), mode),
                                       maploop::tools::columns_of(STDOUT_FILENO));
      });
  app.footer(
      "Pages that a help text names are in the source tree, and below share/doc/maploop where "
      "maploop is installed.");
  app.set_version_flag("--version", MAPLOOP_VERSION);
  maploop::tools::Command command;
  maploop::tools::add_calibrate(app, command);
  maploop::tools::add_dashboard(app, command);
  maploop::tools::add_doctor(app, command);
  maploop::tools::add_evaluate(app, command);
  maploop::tools::add_experiment(app, command);
  maploop::tools::add_gnss(app, command);
  maploop::tools::add_live(app, command);
  maploop::tools::add_log(app, command);
  maploop::tools::add_map(app, command);
  maploop::tools::add_match(app, command);
  maploop::tools::add_odometry(app, command);
  maploop::tools::add_ppp(app, command);
  maploop::tools::add_profile(app, command);
  maploop::tools::add_replay(app, command);
  maploop::tools::add_send(app, command);
  maploop::tools::add_sensors(app, command);
  maploop::tools::add_simulate(app, command);
  maploop::tools::add_spy(app, command);
  try {
    app.parse(argc, argv);
    const int status = command();
    if (printed_all()) return status;
    std::cerr << "maploop: standard output was not taken: it is closed, or its disk is full\n";
    return status != 0 ? status : 1;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    std::cerr << maploop::tools::usage_error(app, e);
    return maploop::tools::exit_usage;
  } catch (const std::bad_alloc&) {
    std::cerr << "maploop: this machine has too little memory for what was asked\n";
    return 1;
  } catch (const std::exception& e) {
    std::cerr << "maploop: " << e.what() << '\n';
    return 1;
  }
}
