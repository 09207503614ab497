#include "tools/command/usage_text.h"

#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "runtime/core/nearest_name.h"
#include "tools/command/examples.h"
#include "tools/command/terminal.h"

namespace maploop::tools {
namespace {

// Where the last column of a line begins that has room for words.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  std::size_t indent = begin;
  for (std::size_t at = line.find("  ", begin); at != std::string_view::npos;
       at = line.find("  ", at)) {
    at = std::min(line.find_first_not_of(' ', at), line.size());
    if (at > width / 2) break;
    indent = at;
  }
  return std::min(indent, width / 2);
}

void append_wrapped(std::string_view line, std::size_t width, std::string& text) {
  const std::size_t indent = hanging_indent(line, width);
  // No break before the column's first word.
  std::size_t room = width, least = std::max(indent, line.find_first_not_of(' '));
  while (line.size() > room) {
    std::size_t end = line.rfind(' ', room);
    if (end == std::string_view::npos || end <= least) end = line.find(' ', std::max(least, room));
    if (end == std::string_view::npos) break;
    text += line.substr(0, end);
    text.resize(text.find_last_not_of(' ') + 1);
    text += '\n' + std::string(indent, ' ');
    line.remove_prefix(std::min(line.find_first_not_of(' ', end), line.size()));
    room = width - indent;
    least = 0;
  }
  text += line;
}

// The innermost subcommand that the command line names.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

std::vector<std::string> names_below(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(sub->get_name());
  }
  return names;
}

// Whether the program of this command understands an example: not every one has all commands and
// options.
bool is_understood(const CLI::App& app, std::string_view example) {
  const CLI::App* command = &app;
  while (command->get_parent() != nullptr) command = command->get_parent();
  const CLI::App* const program = command;
  std::istringstream words{std::string(example)};
  for (std::string word; words >> word;) {
    if (std::ranges::count(names_below(*command), word) > 0) {
      command = command->get_subcommand(word);
    } else if (word.starts_with("--") && command->get_option_no_throw(word) == nullptr) {
      return false;
    }
  }
  return command != program;
}

std::vector<std::string> options_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string meant(const std::string& word, const std::vector<std::string>& names) {
  const std::string nearest = runtime::nearest_name(word, names);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t width) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    append_wrapped(text.substr(0, end), width, result);
    if (end == std::string_view::npos) break;
    result += '\n';
    text.remove_prefix(end + 1);
  }
  return result;
}

std::string words_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : words_of(*app.get_parent()) + ' ' + app.get_name();
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  return wrapped(CLI::Formatter::make_help(app, std::move(name), mode), columns_of(STDOUT_FILENO));
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  constexpr std::size_t most = 3;
  const std::string words = words_of(*app);
  const std::string program = words.substr(0, words.find(' '));
  const std::string command = words.substr(std::min(program.size() + 1, words.size()));
  std::size_t count = 0;
  std::string lines;
  for (const std::string_view line : examples(command)) {
    if (count == most || !is_understood(*app, line)) continue;
    lines += "    " + program + ' ' + std::string(line) + '\n';
    ++count;
  }
  const std::string usual = CLI::Formatter::make_description(app);
  return lines.empty() ? usual : usual + "\nExamples:\n" + lines + '\n';
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  const std::string words = words_of(command);
  const std::vector<std::string> unknown = app.remaining(true);
  const std::vector<std::string> below = names_below(command);
  if (command.get_require_subcommand_min() > 0 && unknown.empty()) return app.help();

  std::string text = "maploop: ";
  if (unknown.empty()) {
    text += error.what();
  } else if (!below.empty() && unknown.front().front() != '-') {
    text += "'" + words + "' has no subcommand '" + unknown.front() + "'" +
            meant(unknown.front(), below);
  } else {
    text += "'" + words + "' does not take '" + unknown.front() + "'" +
            meant(unknown.front(), options_of(command));
  }
  return text + "\n'" + words + " --help' explains it\n";
}

}  // namespace maploop::tools
