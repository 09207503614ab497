#include <algorithm>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "runtime/core/config.h"
#include "runtime/core/config_context.h"
#include "runtime/core/config_state.h"
#include "runtime/core/key_depth.h"
#include "runtime/core/nearest_name.h"

namespace maploop::runtime {
namespace detail {

std::string printable(std::string_view text) {
  constexpr std::size_t longest_shown = 80;
  std::string shown(text.substr(0, longest_shown));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text.size() > longest_shown ? shown + "..." : shown;
}

std::string dotted(const std::string& path, std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  const std::string name = bare ? printable(key) : '"' + printable(key) + '"';
  return path.empty() ? name : path + '.' + name;
}

std::string place(const std::string& file, const toml::source_position& at) {
  return file + ':' + std::to_string(at.line) + ':' + std::to_string(at.column) + ": ";
}

}  // namespace detail

namespace {

using detail::ConfigNode;
using detail::ConfigState;
using detail::dotted;
using detail::place;
using detail::printable;

std::string known_in(const ConfigNode& node) {
  std::vector<std::string> known = node.known;
  std::sort(known.begin(), known.end());
  std::string text;
  for (const std::string& key : known) text += (text.empty() ? "" : ", ") + dotted("", key);
  return (node.path.empty() ? "at the top level" : "in [" + node.path + "]") +
         (text.empty() ? std::string(" no key is known") : " the keys are: " + text);
}

// Returns the nearest key of the same table, otherwise the same name in another one, otherwise "".
std::string guess(const ConfigState& state, const ConfigNode& node, std::string_view key) {
  if (std::string near = nearest_name(key, node.known); !near.empty()) {
    return dotted(node.path, near);
  }
  for (const ConfigNode& other : state.nodes) {
    if (std::find(other.known.begin(), other.known.end(), key) != other.known.end()) {
      return dotted(other.path, key);
    }
  }
  return {};
}

// Returns what has taken the place of an unknown key and, if it is a table, of the keys in it.
std::string place_now(std::span<const MovedKey> moved, const std::string& name,
                      const toml::node& value) {
  std::string text;
  for (const MovedKey& key : moved) {
    if (key.name == name) return "its place is now " + std::string(key.now);
    const bool in_it = value.is_table() && key.name.starts_with(name + '.') &&
                       value.as_table()->contains(key.name.substr(name.size() + 1));
    if (!in_it) continue;
    text += (text.empty() ? "the place of " : ", of ") + std::string(key.name) + " is now " +
            std::string(key.now);
  }
  return text;
}

struct Unknown {
  toml::source_position at;
  std::string text;
};

void collect_unknown(const ConfigState& state, const ConfigNode& node,
                     std::span<const MovedKey> moved, std::vector<Unknown>& all) {
  if (node.table == nullptr) return;
  for (const auto& [key, value] : *node.table) {
    if (std::find(node.known.begin(), node.known.end(), key.str()) != node.known.end()) continue;
    const std::string name = dotted(node.path, key.str());
    std::string advice = place_now(moved, name, value);
    if (advice.empty()) {
      const std::string near = guess(state, node, key.str());
      advice = (near.empty() ? "" : "did you mean " + near + "? ") + known_in(node);
    }
    const toml::source_position at = key.source().begin;
    std::string what = place(state.file, at);
    what.append(name).append(": unknown key; ").append(advice);
    all.push_back({at, std::move(what)});
  }
}

}  // namespace

ConfigDocument::ConfigDocument(std::shared_ptr<ConfigState> state) : state_(std::move(state)) {}

ConfigDocument ConfigDocument::load(const std::filesystem::path& path) {
  try {
    return parse(read_text(path, input_limits::settings), path.string());
  } catch (const FileError& error) {
    throw ConfigError(std::string(error.what()) + "; name a TOML file that may be read");
  }
}

ConfigDocument ConfigDocument::parse(std::string_view text, std::string name) {
  auto state = std::make_shared<ConfigState>();
  state->file = std::move(name);
  if (const std::size_t line = KeyDepth(text).first_deeper_than(input_limits::key_depth)) {
    throw ConfigError(state->file + ':' + std::to_string(line) + ": a key of more than " +
                      std::to_string(input_limits::key_depth) + " parts between dots");
  }
  try {
    state->root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const std::string where = place(state->file, error.source().begin);
    throw ConfigError(where + detail::context_of(text, error) + printable(error.description()));
  }
  return ConfigDocument(std::move(state));
}

ConfigTable ConfigDocument::root() const {
  return {state_, state_->node("", &state_->root)};
}

void ConfigDocument::reject_unknown(std::span<const MovedKey> moved) const {
  std::vector<Unknown> unknown;
  root();  // the keys of a document that was never read are unknown too
  for (const ConfigNode& node : state_->nodes) collect_unknown(*state_, node, moved, unknown);
  if (unknown.empty()) return;
  std::sort(unknown.begin(), unknown.end(), [](const Unknown& a, const Unknown& b) {
    return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
  });
  std::string text;
  for (const Unknown& one : unknown) text += (text.empty() ? "" : "\n") + one.text;
  throw ConfigError(text);
}

}  // namespace maploop::runtime
