#include "tools/command/matcher_options.h"

#include "tools/command/option_checks.h"
#include "tools/match/parameter_settings.h"

namespace maploop::tools {

mapmatch::RuleBases MatcherOptions::rule_bases() const {
  return mapmatch::read_rule_bases(rules);
}

mapmatch::MatchParameters MatcherOptions::parameters() const {
  mapmatch::MatchParameters parameters;
  match::apply_settings(set, parameters);
  return parameters;
}

void add_matcher_options(CLI::App& command, MatcherOptions& options) {
  command.add_option("--rules", options.rules, "Folder with rule bases of your own (.fll)")
      ->check(existing_folder());
  command.add_option("--set", options.set, "NAME=VALUE of a parameter of [mapmatch]");
}

}  // namespace maploop::tools
