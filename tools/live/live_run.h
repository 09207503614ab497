// One drive with live sensors: what it was asked for, and how it runs.
#pragma once

#include "tools/command/run_options.h"

namespace maploop::tools {

struct LiveOptions : RunOptions {
  double seconds = 0.0;  // 0: until it is stopped
};

// Runs until SIGINT or SIGTERM, or for so long; then prints the verdict and writes the files
// asked for. Returns the command's exit status: 1 when a thread failed, no sensor delivered
// anything, or the log does not hold everything. Throws std::runtime_error naming the file or the
// key that is wrong, before it starts.
int live(const LiveOptions& options);

}  // namespace maploop::tools
