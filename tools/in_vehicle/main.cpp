// maploop-vehicle: what a car needs, with few libraries.
#include "tools/command/program.h"

namespace {

using namespace maploop::tools;

constexpr WritePage* no_page = nullptr;

constexpr AddCommand* commands[] = {
    [](CLI::App& app, Command& command) { add_live(app, command, no_page); },
    [](CLI::App& app, Command& command) { add_replay(app, command, no_page); },
};

}  // namespace

int main(int argc, char** argv) {
  return run({"maploop-vehicle", MAPLOOP_VERSION, commands}, argc, argv);
}
