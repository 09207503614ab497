// Options that take names of an enumeration.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "msgs/named_enum.h"

namespace maploop::tools {

template <NamedEnum Enum>
std::vector<std::string> choices() {
  const auto all = names_of(Enum{});
  return {all.begin(), all.end()};
}

// One of them; `value` stays empty where the option is not given.
template <NamedEnum Enum>
CLI::Option* add_choice(CLI::App* sub, const char* flag, std::optional<Enum>& value,
                        const char* what) {
  return sub
      ->add_option_function<std::string>(
          flag, [&value](const std::string& name) { value = value_named<Enum>(name); }, what)
      ->check(CLI::IsMember(choices<Enum>()));
}

// Some of them, with commas between; `values` holds those that are meant without the option.
template <NamedEnum Enum>
CLI::Option* add_choices(CLI::App* sub, const char* flag, std::vector<Enum>& values,
                         const char* what) {
  std::vector<std::string> names;
  for (const Enum value : values) names.emplace_back(name_of(value));
  return sub
      ->add_option_function<std::vector<std::string>>(
          flag,
          [&values](const std::vector<std::string>& given) {
            values.clear();
            for (const std::string& name : given) values.push_back(*value_named<Enum>(name));
          },
          what)
      ->delimiter(',')
      ->check(CLI::IsMember(choices<Enum>()))
      ->default_str(CLI::detail::join(names));
}

}  // namespace maploop::tools
