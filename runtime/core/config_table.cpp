#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
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

// The unit in which a number states a duration.
double nanoseconds_a_unit(std::string_view key) {
  using Unit = std::pair<std::string_view, double>;
  for (const auto& [suffix, ns] : {Unit{"_ns", 1.0}, {"_us", 1e3}, {"_ms", 1e6}, {"_s", 1e9}}) {
    if (key.ends_with(suffix)) return ns;
  }
  throw std::logic_error("configuration: the key '" + std::string(key) +
                         "' of a duration must end in _ns, _us, _ms or _s");
}

// This is a value that exists, with all data for an error about it.
struct Entry {
  const ConfigState& state;
  const ConfigNode& node;
  std::string_view key;
  const toml::node& value;

  [[noreturn]] void fail(const std::string& problem) const {
    throw ConfigError(place(state.file, value.source().begin) + dotted(node.path, key) + ": " +
                      problem);
  }
  [[noreturn]] void wrong_type(const std::string& wanted) const {
    fail("is " + type_name(value) + "; it must be " + wanted);
  }
  [[noreturn]] void out_of_range(const std::string& is, const std::string& lowest,
                                 const std::string& highest) const {
    fail("is " + is + "; allowed is " + lowest + " to " + highest);
  }

  double number() const {
    if (const auto* integer = value.as_integer()) return static_cast<double>(integer->get());
    const auto* floating = value.as_floating_point();
    if (floating == nullptr) wrong_type("a number");
    if (!std::isfinite(floating->get())) {
      fail("is " + shortest_text(floating->get()) + "; it must be a finite number");
    }
    return floating->get();
  }

  int integer(int lowest, int highest) const {
    const auto* integer = value.as_integer();
    if (integer == nullptr) wrong_type("an integer");
    if (integer->get() < lowest || integer->get() > highest) {
      out_of_range(std::to_string(integer->get()), std::to_string(lowest), std::to_string(highest));
    }
    return static_cast<int>(integer->get());
  }

  Duration duration(Duration lowest, Duration highest) const {
    const double unit = nanoseconds_a_unit(key), given = number(), ns = given * unit;
    const auto in_unit = [unit](Duration d) {
      return shortest_text(static_cast<double>(d.count()) / unit);
    };
    // The value is checked against the range of int64 first, then exactly.
    constexpr double beyond_int64 = 9223372036854775808.0;
    const bool held = std::abs(ns) < beyond_int64;
    const Duration result = held ? Duration(std::llround(ns)) : Duration{};
    if (!held || result < lowest || result > highest) {
      out_of_range(shortest_text(given), in_unit(lowest), in_unit(highest));
    }
    return result;
  }

  std::string text(const std::string& wanted = "a string") const {
    const auto* text = value.as_string();
    if (text == nullptr) wrong_type(wanted);
    return text->get();
  }

  // Returns read(entry) of each element of an array.
  template <class Read>
  auto elements(const std::string& wanted, Read read) const {
    const auto* array = value.as_array();
    if (array == nullptr) wrong_type(wanted);
    std::vector<decltype(read(*this))> all;
    for (const toml::node& element : *array) all.push_back(read(Entry{state, node, key, element}));
    return all;
  }
};

// Returns the value of `key` if the file has it; the key counts as known from then on.
std::optional<Entry> find(const ConfigState& state, ConfigNode& node, std::string_view key) {
  if (std::find(node.known.begin(), node.known.end(), key) == node.known.end()) {
    node.known.emplace_back(key);
  }
  const toml::node* value = node.table == nullptr ? nullptr : node.table->get(key);
  return value == nullptr ? std::nullopt : std::optional(Entry{state, node, key, *value});
}

}  // namespace

ConfigTable::ConfigTable(std::shared_ptr<ConfigState> state, ConfigNode* node)
    : state_(std::move(state)), node_(node) {}

bool ConfigTable::has(std::string_view key) const {
  return find(*state_, *node_, key).has_value();
}

void ConfigTable::read(std::string_view key, double& value) const {
  if (const auto entry = find(*state_, *node_, key)) value = entry->number();
}

void ConfigTable::read(std::string_view key, int& value) const {
  read_in(key, value, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

void ConfigTable::read(std::string_view key, Duration& value) const {
  read_in(key, value, Duration::min(), Duration::max());
}

void ConfigTable::read(std::string_view key, bool& value) const {
  const auto entry = find(*state_, *node_, key);
  if (!entry) return;
  const auto* boolean = entry->value.as_boolean();
  if (boolean == nullptr) entry->wrong_type("true or false");
  value = boolean->get();
}

void ConfigTable::read(std::string_view key, std::string& value) const {
  if (const auto entry = find(*state_, *node_, key)) value = entry->text();
}

void ConfigTable::read(std::string_view key, std::vector<std::string>& values) const {
  const std::string wanted = "an array of strings";
  if (const auto entry = find(*state_, *node_, key)) {
    values = entry->elements(wanted, [&](const Entry& element) { return element.text(wanted); });
  }
}

void ConfigTable::read(std::string_view key, std::span<double> values) const {
  const auto entry = find(*state_, *node_, key);
  if (!entry) return;
  const std::string wanted = "an array of " + std::to_string(values.size()) + " numbers";
  const std::vector<double> numbers =
      entry->elements(wanted, [](const Entry& element) { return element.number(); });
  if (numbers.size() != values.size()) {
    entry->fail("has " + std::to_string(numbers.size()) + " elements; it must be " + wanted);
  }
  std::copy(numbers.begin(), numbers.end(), values.begin());
}

void ConfigTable::read_in(std::string_view key, int& value, int lowest, int highest) const {
  if (const auto entry = find(*state_, *node_, key)) value = entry->integer(lowest, highest);
}

void ConfigTable::read_in(std::string_view key, std::vector<int>& values, int lowest,
                          int highest) const {
  if (const auto entry = find(*state_, *node_, key)) {
    values = entry->elements("an array of integers", [&](const Entry& element) {
      return element.integer(lowest, highest);
    });
  }
}

void ConfigTable::read_in(std::string_view key, Duration& value, Duration lowest,
                          Duration highest) const {
  nanoseconds_a_unit(key);  // a key without a unit is a bug, even if the file does not contain it
  if (const auto entry = find(*state_, *node_, key)) value = entry->duration(lowest, highest);
}

void ConfigTable::read_one_of(std::string_view key, std::string& value,
                              std::span<const std::string_view> allowed) const {
  const auto entry = find(*state_, *node_, key);
  if (!entry) return;
  const std::string text = entry->text();
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
    const std::vector<std::string> names(allowed.begin(), allowed.end());
    const std::string near = nearest_name(text, names);
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + '"';
    entry->fail("is \"" + printable(text) + "\"; " +
                (near.empty() ? "" : "did you mean \"" + near + "\"? ") + "allowed is " + list);
  }
  value = text;
}

ConfigTable ConfigTable::table(std::string_view key) const {
  const auto entry = find(*state_, *node_, key);
  if (entry && !entry->value.is_table()) entry->wrong_type("a table");
  return {state_,
          state_->node(dotted(node_->path, key), entry ? entry->value.as_table() : nullptr)};
}

void ConfigTable::fail(std::string_view key, std::string_view problem) const {
  if (const auto entry = find(*state_, *node_, key)) entry->fail(std::string(problem));
  throw ConfigError(state_->file + ": " + dotted(node_->path, key) + ": " + std::string(problem));
}

}  // namespace maploop::runtime
