// What is wrong with a command line, and what to do.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace maploop::tools {

constexpr int exit_usage = 2;

// One or two lines: the error, the name that was perhaps meant, and whose --help to read. For the
// command itself or a group of commands without a subcommand: that help.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace maploop::tools
