// Options that several commands have, each described once.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/named_enum.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/output/lcm_bus.h"

namespace maploop::tools {

// --lcm-url, the same for every command that uses the bus. `url` stays empty without the option:
// vehicle::bus_url() then chooses one.
CLI::Option* add_lcm_url(CLI::App* sub, std::string& url);

// --config FILE.
CLI::Option* add_config(CLI::App* sub, std::filesystem::path& file,
                        const char* what = "TOML file of parameters");

// --set TABLE.KEY=VALUE, more than once, in place of what the file says.
CLI::Option* add_settings(CLI::App* sub, std::vector<std::string>& settings);

// --topic SENSOR=TOPIC, more than once, of a bag or an MCAP file.
CLI::Option* add_topics(CLI::App* sub, std::vector<std::string>& topics);

// A file that is written at the end of the work.
CLI::Option* add_output(CLI::App* sub, const char* flag, std::filesystem::path& file,
                        const char* what);

// Applies --map and --map-mode to a configuration; an empty one changes nothing. Throws
// std::runtime_error if the mode needs a map and there is none.
void set_map(vehicle::MapParameters& map, const std::filesystem::path& file,
             std::optional<vehicle::MapMode> mode);

// Checks a text with a parser that throws std::invalid_argument.
template <class Parse>
CLI::Validator parsed_by(Parse parse, const char* shown) {
  return {[parse](const std::string& text) {
            try {
              parse(text);
            } catch (const std::invalid_argument& e) {
              return std::string(e.what());
            }
            return std::string();
          },
          shown};
}

template <NamedEnum Enum>
std::vector<std::string> choices() {
  const auto all = names_of(Enum{});
  return {all.begin(), all.end()};
}

// One name of an enumeration, of those that are accepted; `value` stays empty without the option.
template <NamedEnum Enum>
CLI::Option* add_choice(CLI::App* sub, const char* flag, std::optional<Enum>& value,
                        const char* what,
                        const std::vector<std::string>& accepted = choices<Enum>()) {
  return sub
      ->add_option_function<std::string>(
          flag, [&value](const std::string& name) { value = value_named<Enum>(name); }, what)
      ->check(CLI::IsMember(accepted));
}

}  // namespace maploop::tools
