// This file reads a configuration from TOML strictly: everything that is not understood is an
// error.
//
//   const ConfigDocument document = ConfigDocument::load("vehicle.toml");
//   const ConfigTable fusion = document.root().table("fusion");
//   fusion.read_in("count", parameters.count, 1, 8);
//   fusion.read("deadline_ms", parameters.deadline);   // a Duration: the key names the unit
//   document.reject_unknown();                         // last: keys that were never read
//
// An absent key leaves the variable, and so its default, unchanged. TOML 1.0. One thread at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/time.h"

namespace maploop::runtime {

// The text has one line for each problem: file:line:column, the full dotted key, what is wrong,
// what is allowed.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace detail {
struct ConfigState;
struct ConfigNode;
}  // namespace detail

// This is a table of the document. It is cheap to copy and keeps the document alive. Every function
// throws ConfigError if the file is wrong.
class ConfigTable {
 public:
  bool has(std::string_view key) const;

  // Floating-point numbers must be finite; an integer is accepted as one too, but not the reverse.
  void read(std::string_view key, double& value) const;
  void read(std::string_view key, int& value) const;
  void read(std::string_view key, bool& value) const;
  void read(std::string_view key, std::string& value) const;
  void read(std::string_view key, std::vector<std::string>& values) const;
  // Reads a number in the unit that ends the key: _ns, _us, _ms or _s; rounded to the nanosecond.
  // Throws std::logic_error if the key has no such ending.
  void read(std::string_view key, Duration& value) const;
  // Reads an array of exactly values.size() numbers, such as a lever arm.
  void read(std::string_view key, std::span<double> values) const;

  // These do the same within lowest..highest, both included; for an array, for each of its
  // elements.
  void read_in(std::string_view key, int& value, int lowest, int highest) const;
  void read_in(std::string_view key, std::vector<int>& values, int lowest, int highest) const;
  void read_in(std::string_view key, Duration& value, Duration lowest, Duration highest) const;

  // Reads a string that must be one of `allowed`.
  void read_one_of(std::string_view key, std::string& value,
                   std::span<const std::string_view> allowed) const;

  // Returns the sub-table `key`; if it is absent, an empty one, so that every default holds.
  ConfigTable table(std::string_view key) const;

  // Throws ConfigError at the position of `key`, for a rule of the caller's: "must be below
  // fusion.rate_hz".
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;

 private:
  friend class ConfigDocument;
  ConfigTable(std::shared_ptr<detail::ConfigState> state, detail::ConfigNode* node);

  std::shared_ptr<detail::ConfigState> state_;
  detail::ConfigNode* node_;
};

// This is a key, or a table, that files of earlier versions have. Its name is dotted; `now` names
// what has taken its place, such as another key.
struct MovedKey {
  std::string_view name;
  std::string_view now;
};

class ConfigDocument {
 public:
  // Throws ConfigError if the file cannot be read, or is not TOML (a duplicate key included).
  static ConfigDocument load(const std::filesystem::path& path);
  // Reads `text`; error texts contain `name` in place of the file.
  static ConfigDocument parse(std::string_view text, std::string name);

  ConfigTable root() const;

  // Throws ConfigError that names every key that was neither read nor asked for, each with what has
  // taken its place, or else with the nearest key that was. Call it when everything has been read.
  void reject_unknown(std::span<const MovedKey> moved = {}) const;

 private:
  explicit ConfigDocument(std::shared_ptr<detail::ConfigState> state);

  std::shared_ptr<detail::ConfigState> state_;
};

}  // namespace maploop::runtime
