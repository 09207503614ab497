// maploop: all commands.
#include "tools/command/program.h"

namespace {

using namespace maploop::tools;

constexpr AddCommand* commands[] = {
    add_calibrate, add_dashboard, add_doctor,  add_evaluate, add_experiment,
    add_gnss,      add_live,      add_log,     add_map,      add_match,
    add_odometry,  add_ppp,       add_profile, add_replay,   add_send,
    add_sensors,   add_simulate,  add_spy,     add_vehicle,
};

}  // namespace

int main(int argc, char** argv) {
  return run({"maploop", MAPLOOP_VERSION, commands}, argc, argv);
}
