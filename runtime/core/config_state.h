// This file contains what config_document.cpp and config_table.cpp share; users of the
// configuration do not need it.
#pragma once

#include <algorithm>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/toml.h"

namespace maploop::runtime::detail {

// This is one table as the program sees it: where it is in the file, and which keys were read.
struct ConfigNode {
  std::string path;                    // dotted; empty for the root
  const toml::table* table = nullptr;  // nullptr if absent from the file
  std::vector<std::string> known;      // keys asked for, in that order
};

struct ConfigState {
  std::string file;
  toml::table root;
  std::deque<ConfigNode> nodes;  // a deque, because tables point into it

  ConfigNode* node(const std::string& path, const toml::table* table) {
    const auto found =
        std::find_if(nodes.begin(), nodes.end(), [&](const auto& n) { return n.path == path; });
    if (found != nodes.end()) return &*found;
    return &nodes.emplace_back(ConfigNode{path, table, {}});
  }
};

// Returns the user's text on one line and with limited length.
std::string printable(std::string_view text);

// Joins "fusion" and "rate" to "fusion.rate"; a key that is not bare is quoted.
std::string dotted(const std::string& path, std::string_view key);

// Returns "file:line:column: ".
std::string place(const std::string& file, const toml::source_position& at);

}  // namespace maploop::runtime::detail
