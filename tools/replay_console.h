// A replay on a terminal: progress line, keys, and a clean end at Ctrl-C.
#pragma once

#include "runtime/vehicle/vehicle.h"

namespace maploop::tools {

struct PlaybackOptions {
  double start = 0.0;       // s into the drive; what lies before goes by as fast as it can
  bool paused = false;      // from the start on
  bool until_miss = false;  // pause at the first missed deadline
  bool verbose = false;     // every real-time setting, not only what was not granted
};

enum class PlaybackEnd { finished, interrupted };

// Starts the vehicle and waits for its end, or for SIGINT, SIGTERM or the key q, which end it in
// order (a second signal ends the program at once). `last` is the drive's last stamp. While
// standard input is a terminal, keys control the player; the progress line names them.
PlaybackEnd play(vehicle::Vehicle& vehicle, Time last, const PlaybackOptions& options);

}  // namespace maploop::tools
