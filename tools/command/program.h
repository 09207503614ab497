// A program of subcommands: how its command line is read, and how it ends.
#pragma once

#include <span>

#include "tools/command/commands.h"

namespace maploop::tools {

struct Program {
  const char* name;
  const char* version;
  std::span<AddCommand* const> commands;
};

// Runs what the command line names, and returns the exit status of the process.
int run(const Program& program, int argc, char** argv);

}  // namespace maploop::tools
