// The options of every command that matches recorded drives to a map: the map, the rules and the
// parameters.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "mapmatch/match_parameters.h"
#include "mapmatch/rule_bases.h"

namespace maploop::tools {

struct MatcherOptions {
  std::filesystem::path map, rules = mapmatch::default_rules();
  std::vector<std::string> set;

  // These throw std::runtime_error naming the file or the setting.
  mapmatch::RuleBases rule_bases() const;
  mapmatch::MatchParameters parameters() const;
};

// Adds --rules and --set. Each command says itself which files its map may be.
void add_matcher_options(CLI::App& command, MatcherOptions& options);

}  // namespace maploop::tools
