// Parameters described once: each member of a struct with its key, range, unit and meaning.
//
//   constexpr auto table = std::to_array<Parameter<LidarParameters>>({
//       {"min_range", &P::min_range, 0.0, 1000.0, "m", Audience::usual, "Nearer points ..."},
//   });
//   ParameterTable<LidarParameters> parameter_table(const LidarParameters&);
//
// The configuration file, its page, checks, archives and command lines work from these tables. The
// default is the struct's own.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "msgs/named_enum.h"

namespace maploop {

// Who changes a parameter.
enum class Audience : std::uint8_t {
  usual,   // whoever has another vehicle, sensor, map or task
  expert,  // whoever works on the method
};

// The data that a value was chosen on. Empty: it comes from physics, from a specification or from
// the literature.
struct DataChoice {
  std::string_view data;
  std::string_view how;
  std::string_view figures;  // published figures that are therefore not unseen
};

// The least value of what must be positive.
inline constexpr double above_zero = std::numeric_limits<double>::min();

struct ParameterDescription {
  std::string_view key;  // the member's name
  double least = 0.0;    // of a number, both ends allowed
  double most = 0.0;
  std::string_view unit;  // of a number; "1": none
  std::string_view meaning;
  Audience audience = Audience::expert;
  DataChoice choice;
  std::span<const std::string_view> names;  // of a text that must be one of them
};

// What a parameter may be; an enumeration is the name of its value.
using ParameterValue =
    std::variant<bool, int, std::int64_t, double, std::string, std::vector<std::string>>;

// "0 to 1000 m", or "\"klt\", \"sift\""; empty where every value of its kind is allowed.
std::string allowed_text(const ParameterDescription& parameter);

struct ParameterProblem {
  std::string_view key;
  std::string text;  // "is -1; allowed is 0 to 1000 m"
};

// As a configuration file writes it.
std::string text_of(const ParameterValue& value);

// What is wrong with a value by itself. A number that is not finite is out of every range.
std::optional<ParameterProblem> problem_of(const ParameterDescription& parameter,
                                           const ParameterValue& value);

// A member that is a NamedEnum with values from 0 on.
template <class Parameters>
struct EnumMember {
  std::size_t (*get)(const Parameters&);
  void (*set)(Parameters&, std::size_t);
  std::span<const std::string_view> names;
};

namespace detail {
template <class Parameters, NamedEnum Enum>
Enum enum_of(Enum Parameters::*);
template <class Parameters, NamedEnum Enum>
Parameters struct_of(Enum Parameters::*);
}  // namespace detail

template <auto member, class Parameters = decltype(detail::struct_of(member)),
          class Enum = decltype(detail::enum_of(member))>
inline constexpr EnumMember<Parameters> one_of{
    [](const Parameters& values) { return static_cast<std::size_t>(values.*member); },
    [](Parameters& values, std::size_t i) { values.*member = static_cast<Enum>(i); },
    enum_names<Enum>};

template <class P>
class Parameter : public ParameterDescription {
 public:
  template <class Number>
  requires std::same_as<Number, int> || std::same_as<Number, std::int64_t> ||
      std::same_as<Number, double>
  constexpr Parameter(std::string_view name, Number P::*number, double lowest, double highest,
                      std::string_view in_unit, Audience whose, std::string_view says,
                      DataChoice chosen = {})
      : ParameterDescription{name, lowest, highest, in_unit, says, whose, chosen, {}},
        member_(number) {}

  template <class Other>
  requires std::same_as<Other, bool> || std::same_as<Other, std::string> ||
      std::same_as<Other, std::vector<std::string>>
  constexpr Parameter(std::string_view name, Other P::*other, Audience whose, std::string_view says,
                      std::span<const std::string_view> allowed = {})
      : ParameterDescription{name, 0.0, 0.0, {}, says, whose, {}, allowed}, member_(other) {}

  constexpr Parameter(std::string_view name, EnumMember<P> choice_of, Audience whose,
                      std::string_view says)
      : ParameterDescription{name, 0.0, 0.0, {}, says, whose, {}, choice_of.names},
        member_(choice_of) {}

  ParameterValue value_in(const P& values) const {
    const auto get = [&](const auto& member) -> ParameterValue {
      if constexpr (requires { member.names; }) {
        const std::size_t i = member.get(values);
        return std::string(i < names.size() ? names[i] : "unknown");
      } else {
        return values.*member;
      }
    };
    return std::visit(get, member_);
  }

  // The value is of the kind that value_in() has, and a text one of the names.
  void set(P& values, const ParameterValue& value) const {
    const auto put = [&](const auto& member) {
      if constexpr (requires { member.names; }) {
        const auto name = std::find(names.begin(), names.end(), std::get<std::string>(value));
        member.set(values, static_cast<std::size_t>(name - names.begin()));
      } else {
        auto& own = values.*member;
        own = std::get<std::remove_reference_t<decltype(own)>>(value);
      }
    };
    std::visit(put, member_);
  }

 private:
  std::variant<bool P::*, int P::*, std::int64_t P::*, double P::*, std::string P::*,
               std::vector<std::string> P::*, EnumMember<P>>
      member_;
};

template <class P>
struct ParameterTable {
  std::string_view name;     // of the table in a configuration file
  std::string_view meaning;  // what its parameters are about
  std::span<const Parameter<P>> parameters;
  // The first broken rule about several of them.
  std::optional<ParameterProblem> (*rules)(const P&) = nullptr;
};

template <class P>
std::optional<ParameterProblem> problem_of(const ParameterTable<P>& table, const P& values) {
  for (const Parameter<P>& parameter : table.parameters) {
    if (auto problem = problem_of(parameter, parameter.value_in(values))) return problem;
  }
  return table.rules != nullptr ? table.rules(values) : std::nullopt;
}

// Throws std::invalid_argument such as "lidar.kernel: is 0; allowed is above 0, at most 1000000".
template <class P>
void validate_parameters(const P& values) {
  const ParameterTable<P> table = parameter_table(values);
  if (const auto problem = problem_of(table, values)) {
    throw std::invalid_argument(std::string(table.name) + '.' + std::string(problem->key) + ": " +
                                problem->text);
  }
}

// Sets the number, or with 0 and 1 the truth, of that key; false where the table has none. Throws
// std::invalid_argument as above where it is out of its range.
template <class P>
bool set_number(P& values, std::string_view key, double number) {
  const ParameterTable<P> table = parameter_table(values);
  for (const Parameter<P>& parameter : table.parameters) {
    if (parameter.key != key) continue;
    ParameterValue value = parameter.value_in(values);
    const auto put = [&](auto& own) {
      using Own = std::remove_reference_t<decltype(own)>;
      if constexpr (std::is_arithmetic_v<Own>) own = static_cast<Own>(number);
      return std::is_arithmetic_v<Own>;
    };
    if (!std::visit(put, value)) return false;
    parameter.set(values, value);
    if (const auto problem = problem_of(parameter, value)) {
      throw std::invalid_argument(std::string(table.name) + '.' + std::string(key) + ": " +
                                  problem->text);
    }
    return true;
  }
  return false;
}

}  // namespace maploop
