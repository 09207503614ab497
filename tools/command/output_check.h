// Refuses outputs that would destroy what is read, or each other.
#pragma once

#include <CLI/CLI.hpp>

namespace maploop::tools {

// Marks an option whose value is a file, or a folder of files, to be written.
CLI::Validator output_place();

// Throws std::runtime_error if a file that a parsed command is to write is also one that it was
// given, or is to be written twice. Devices and pipes are left alone.
void check_outputs(CLI::App& app);

}  // namespace maploop::tools
