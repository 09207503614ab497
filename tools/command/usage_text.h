// Texts that explain how the command is used.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <string_view>

namespace maploop::tools {

constexpr int exit_usage = 2;

// Breaks lines that are longer than `width` between words. The rest of a line stands below the last
// column of the line, or below the line's first word if the line is not part of a table; columns
// are at least two blanks apart. A word that is too long stays whole.
std::string wrapped(std::string_view text, std::size_t width);

// The words of a command, such as "maploop log info".
std::string words_of(const CLI::App& app);

// Help whose lines end within the terminal, and which begins with examples.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_description(const CLI::App* app) const override;
};

// Returns one or two lines: the error, the name that was perhaps meant, and whose --help to read.
// Without a subcommand where one is needed, returns the help instead.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace maploop::tools
