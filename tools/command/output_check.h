// Refuses outputs that would destroy what is read, or each other.
#pragma once

#include <CLI/CLI.hpp>

namespace maploop::tools {

// How an option names what is written: FILE (or a folder of files), SECONDS:FILE, or FILE with
// FILE.ppp beside it.
enum class OutputName { file, after_colon, with_ppp };

// Marks an option whose value is to be written.
CLI::Validator output_place(OutputName name = OutputName::file);

// Throws std::runtime_error if a file that a parsed command is to write is also one that it was
// given, is there in a folder that it was given, or is to be written twice. Devices and pipes are
// left alone.
void check_outputs(CLI::App& app);

}  // namespace maploop::tools
