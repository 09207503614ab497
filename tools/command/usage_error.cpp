#include "tools/command/usage_error.h"

#include <vector>

#include "runtime/core/nearest_name.h"

namespace maploop::tools {
namespace {

// The innermost subcommand that the command line names.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

std::string words_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : words_of(*app.get_parent()) + ' ' + app.get_name();
}

std::vector<std::string> names_below(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(sub->get_name());
  }
  return names;
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
