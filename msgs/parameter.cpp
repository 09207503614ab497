#include "msgs/parameter.h"

#include <charconv>
#include <cmath>

#include "msgs/archive.h"

namespace maploop {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

// With all its digits, and without an exponent where that is readable.
std::string number_text(double value) {
  const double size = std::abs(value);
  if (!(size >= 1e-6 && size < 1e10)) return shown(value);
  std::array<char, 32> text{};
  return {
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr};
}

}  // namespace

std::string text_of(const ParameterValue& value) {
  const auto text = []<class T>(const T& own) {
    if constexpr (std::same_as<T, std::string>) {
      return quoted(own);
    } else if constexpr (std::same_as<T, std::vector<std::string>>) {
      std::string list;
      for (const std::string& one : own) list += (list.empty() ? "" : ", ") + quoted(one);
      return '[' + list + ']';
    } else if constexpr (std::same_as<T, double>) {
      const std::string number = shown(own);
      // TOML takes a number without point and exponent for an integer.
      return number.find_first_of(".en") == std::string::npos ? number + ".0" : number;
    } else {
      return shown(own);
    }
  };
  return std::visit(text, value);
}

std::string allowed_text(const ParameterDescription& parameter) {
  std::string text;
  for (const std::string_view name : parameter.names)
    text += (text.empty() ? "\"" : ", \"") + std::string(name) + '"';
  if (!(parameter.least < parameter.most)) return text;
  text =
      parameter.least == above_zero ? "above 0, at most " : number_text(parameter.least) + " to ";
  text += number_text(parameter.most);
  return parameter.unit == "1" ? text : text + ' ' + std::string(parameter.unit);
}

std::optional<ParameterProblem> problem_of(const ParameterDescription& parameter,
                                           const ParameterValue& value) {
  const auto& names = parameter.names;
  const auto allowed = [&]<class T>(const T& own) {
    if constexpr (std::same_as<T, std::string>) {
      return names.empty() || std::find(names.begin(), names.end(), own) != names.end();
    } else if constexpr (std::is_arithmetic_v<T> && !std::same_as<T, bool>) {
      const auto number = static_cast<double>(own);
      return number >= parameter.least && number <= parameter.most;  // false for NaN
    } else {
      return true;
    }
  };
  if (std::visit(allowed, value)) return std::nullopt;
  const auto is = [](const auto& own) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(own)>>) {
      return number_text(static_cast<double>(own));
    } else {
      return text_of(own);
    }
  };
  return ParameterProblem{
      parameter.key, "is " + std::visit(is, value) + "; allowed is " + allowed_text(parameter)};
}

}  // namespace maploop
