// A replay on a terminal: progress line, keys, and a clean end at Ctrl-C.
#pragma once

#include "runtime/vehicle/output/runs.h"
#include "runtime/vehicle/playback/player.h"
#include "runtime/vehicle/playback/replay_control.h"

namespace maploop::tools {

struct PlaybackOptions {
  bool paused = false;      // from the start on
  bool until_miss = false;  // pause at the first missed deadline
};

enum class PlaybackEnd { finished, interrupted };

// Starts the player and waits for its end, or for SIGINT, SIGTERM, the key q or a command to quit,
// which end it in order (a second signal ends the program at once). While standard input is a
// terminal, keys control the player; the progress line names them. `control` and `presence` are
// null where there is no bus. `verbose`: says every real-time setting, not only what was not
// granted.
PlaybackEnd play(vehicle::Player& player, vehicle::ReplayControl* control,
                 vehicle::RunPresence* presence, const PlaybackOptions& options, bool verbose);

}  // namespace maploop::tools
