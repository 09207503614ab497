#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/core/config.h"
#include "runtime/core/config_state.h"
#include "runtime/core/nearest_name.h"
#include "runtime/core/number_text.h"

namespace maploop::runtime {
namespace {

using detail::ConfigNode;
using detail::ConfigState;
using detail::dotted;
using detail::place;
using detail::printable;

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return node.is_array_of_tables() ? "an array of tables" : "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a floating-point number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

[[noreturn]] void fail_at(const ConfigState& state, const ConfigNode& node, std::string_view key,
                          const toml::node* value, std::string_view problem) {
  std::string where = state.file + ": ";
  if (value != nullptr) where = place(state.file, value->source().begin);
  throw ConfigError(where + dotted(node.path, key) + ": " + std::string(problem));
}

// Returns the value of `key`, or nullptr if it is absent; the key counts as known from then on.
const toml::node* find(ConfigNode& node, std::string_view key) {
  if (std::find(node.known.begin(), node.known.end(), key) == node.known.end()) {
    node.known.emplace_back(key);
  }
  return node.table == nullptr ? nullptr : node.table->get(key);
}

// This is a value that exists, with all data for an error about it.
struct Entry {
  const ConfigState& state;
  const ConfigNode& node;
  std::string_view key;
  const toml::node& value;

  [[noreturn]] void fail(const std::string& problem) const {
    fail_at(state, node, key, &value, problem);
  }
  [[noreturn]] void wrong_type(const std::string& wanted) const {
    fail("is " + type_name(value) + "; it must be " + wanted);
  }
  [[noreturn]] void out_of_range(const std::string& is, const std::string& lowest,
                                 const std::string& highest) const {
    fail("is " + is + "; allowed is " + lowest + " to " + highest);
  }
};

double finite_number(const Entry& entry, const toml::node& value) {
  if (const auto* integer = value.as_integer()) return static_cast<double>(integer->get());
  const auto* floating = value.as_floating_point();
  if (floating == nullptr) entry.fail("is " + type_name(value) + "; it must be a number");
  if (!std::isfinite(floating->get())) {
    entry.fail("is " + shortest_text(floating->get()) + "; it must be a finite number");
  }
  return floating->get();
}

double read_number(const Entry& entry, double lowest, double highest) {
  const double value = finite_number(entry, entry.value);
  if (value < lowest || value > highest) {
    entry.out_of_range(shortest_text(value), shortest_text(lowest), shortest_text(highest));
  }
  return value;
}

int read_integer(const Entry& entry, int lowest, int highest) {
  const auto* integer = entry.value.as_integer();
  if (integer == nullptr) entry.wrong_type("an integer");
  if (integer->get() < lowest || integer->get() > highest) {
    entry.out_of_range(std::to_string(integer->get()), std::to_string(lowest),
                       std::to_string(highest));
  }
  return static_cast<int>(integer->get());
}

struct Unit {
  std::string_view suffix;
  double nanoseconds;
};

Unit unit_of(std::string_view key) {
  for (const Unit unit : {Unit{"_ns", 1.0}, {"_us", 1e3}, {"_ms", 1e6}, {"_s", 1e9}}) {
    if (key.ends_with(unit.suffix)) return unit;
  }
  throw std::logic_error("configuration: the key '" + std::string(key) +
                         "' of a duration must end in _ns, _us, _ms or _s");
}

Duration read_duration(const Entry& entry, Duration lowest, Duration highest) {
  const Unit unit = unit_of(entry.key);
  const double given = finite_number(entry, entry.value);
  const double ns = given * unit.nanoseconds;
  const auto in_unit = [&unit](Duration d) {
    return shortest_text(static_cast<double>(d.count()) / unit.nanoseconds);
  };
  // The value is checked against the range of int64 first, then exactly.
  constexpr double kBeyond = 9223372036854775808.0;
  const bool held = std::abs(ns) < kBeyond;
  const Duration value = held ? Duration(std::llround(ns)) : Duration{};
  if (!held || value < lowest || value > highest) {
    entry.out_of_range(shortest_text(given), in_unit(lowest), in_unit(highest));
  }
  return value;
}

}  // namespace

ConfigTable::ConfigTable(std::shared_ptr<ConfigState> state, ConfigNode* node)
    : state_(std::move(state)), node_(node) {}

bool ConfigTable::has(std::string_view key) const {
  return find(*node_, key) != nullptr;
}

void ConfigTable::read(std::string_view key, double& value) const {
  constexpr double kLargest = std::numeric_limits<double>::max();
  read_in(key, value, -kLargest, kLargest);
}

void ConfigTable::read(std::string_view key, int& value) const {
  read_in(key, value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

void ConfigTable::read(std::string_view key, Duration& value) const {
  read_in(key, value, Duration::min(), Duration::max());
}

void ConfigTable::read(std::string_view key, bool& value) const {
  const toml::node* node = find(*node_, key);
  if (node == nullptr) return;
  const auto* boolean = node->as_boolean();
  if (boolean == nullptr) Entry{*state_, *node_, key, *node}.wrong_type("true or false");
  value = boolean->get();
}

void ConfigTable::read(std::string_view key, std::string& value) const {
  const toml::node* node = find(*node_, key);
  if (node == nullptr) return;
  const auto* text = node->as_string();
  if (text == nullptr) Entry{*state_, *node_, key, *node}.wrong_type("a string");
  value = text->get();
}

void ConfigTable::read(std::string_view key, std::vector<std::string>& values) const {
  const toml::node* node = find(*node_, key);
  if (node == nullptr) return;
  const Entry entry{*state_, *node_, key, *node};
  const auto* array = node->as_array();
  if (array == nullptr) entry.wrong_type("an array of strings");
  std::vector<std::string> read;  // read first, so that an error leaves `values` unchanged
  for (const toml::node& element : *array) {
    const auto* text = element.as_string();
    if (text == nullptr) Entry{*state_, *node_, key, element}.wrong_type("an array of strings");
    read.push_back(text->get());
  }
  values = std::move(read);
}

void ConfigTable::read(std::string_view key, std::span<double> values) const {
  const toml::node* node = find(*node_, key);
  if (node == nullptr) return;
  const Entry entry{*state_, *node_, key, *node};
  const std::string wanted = "an array of " + std::to_string(values.size()) + " numbers";
  const auto* array = node->as_array();
  if (array == nullptr) entry.wrong_type(wanted);
  if (array->size() != values.size()) {
    entry.fail("has " + std::to_string(array->size()) + " elements; it must be " + wanted);
  }
  std::vector<double> numbers;  // read first, so that an error leaves `values` unchanged
  for (const toml::node& element : *array) {
    const Entry one{*state_, *node_, key, element};
    numbers.push_back(finite_number(one, element));
  }
  std::copy(numbers.begin(), numbers.end(), values.begin());
}

void ConfigTable::read_in(std::string_view key, double& value, double lowest,
                          double highest) const {
  if (const toml::node* node = find(*node_, key)) {
    value = read_number({*state_, *node_, key, *node}, lowest, highest);
  }
}

void ConfigTable::read_in(std::string_view key, int& value, int lowest, int highest) const {
  if (const toml::node* node = find(*node_, key)) {
    value = read_integer({*state_, *node_, key, *node}, lowest, highest);
  }
}

void ConfigTable::read_in(std::string_view key, std::vector<int>& values, int lowest,
                          int highest) const {
  const toml::node* node = find(*node_, key);
  if (node == nullptr) return;
  const auto* array = node->as_array();
  if (array == nullptr) Entry{*state_, *node_, key, *node}.wrong_type("an array of integers");
  std::vector<int> read;  // read first, so that an error leaves `values` unchanged
  for (const toml::node& element : *array) {
    read.push_back(read_integer({*state_, *node_, key, element}, lowest, highest));
  }
  values = std::move(read);
}

void ConfigTable::read_in(std::string_view key, Duration& value, Duration lowest,
                          Duration highest) const {
  unit_of(key);  // a key without a unit is a bug, even if the file does not contain it
  if (const toml::node* node = find(*node_, key)) {
    value = read_duration({*state_, *node_, key, *node}, lowest, highest);
  }
}

void ConfigTable::read_one_of(std::string_view key, std::string& value,
                              const std::vector<std::string_view>& allowed) const {
  std::string text = value;
  read(key, text);
  if (!has(key)) return;
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
    const std::vector<std::string> names(allowed.begin(), allowed.end());
    const std::string near = nearest_name(text, names);
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + '"';
    fail(key, "is \"" + printable(text) + "\"; " +
                  (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "allowed is " + list);
  }
  value = text;
}

ConfigTable ConfigTable::table(std::string_view key) const {
  const toml::node* node = find(*node_, key);
  if (node != nullptr && !node->is_table()) {
    Entry{*state_, *node_, key, *node}.wrong_type("a table");
  }
  return {state_,
          state_->node(dotted(node_->path, key), node == nullptr ? nullptr : node->as_table())};
}

std::vector<ConfigTable> ConfigTable::tables(std::string_view key) const {
  const toml::node* node = find(*node_, key);
  if (node == nullptr) return {};
  const auto* array = node->as_array();
  if (array == nullptr || (!array->empty() && !array->is_array_of_tables())) {
    Entry{*state_, *node_, key, *node}.wrong_type("an array of tables");
  }
  std::vector<ConfigTable> all;
  for (const toml::node& element : *array) {
    const std::string path = dotted(node_->path, key) + '[' + std::to_string(all.size()) + ']';
    all.push_back({state_, state_->node(path, element.as_table())});
  }
  return all;
}

void ConfigTable::fail(std::string_view key, std::string_view problem) const {
  fail_at(*state_, *node_, key, find(*node_, key), problem);
}

}  // namespace maploop::runtime
