// maploop: all commands.
#include "tools/command/program.h"
#include "tools/report/report.h"

namespace {

using namespace maploop::tools;

void live_and_page(CLI::App& app, Command& command) {
  add_live(app, command, maploop::report::write_report);
}

void replay_and_page(CLI::App& app, Command& command) {
  add_replay(app, command, maploop::report::write_report);
}

constexpr AddCommand* commands[] = {
    add_analyze,    add_calibrate, add_dashboard, add_doctor,  add_evaluate,
    add_experiment, add_gnss,      live_and_page, add_log,     add_map,
    add_match,      add_odometry,  add_ppp,       add_profile, replay_and_page,
    add_send,       add_sensors,   add_simulate,  add_spy,     add_vehicle,
};

}  // namespace

int main(int argc, char** argv) {
  return run({"maploop", MAPLOOP_VERSION, commands}, argc, argv);
}
