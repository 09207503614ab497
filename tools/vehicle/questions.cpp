#include <charconv>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "msgs/trimmed.h"
#include "tools/vehicle/vehicle_tool.h"

namespace maploop::vehicle_tool {
namespace {

// Reads an answer as the kind of value that a parameter has; returns nothing if it is none.
std::optional<ParameterValue> parsed(const std::string& text, ParameterValue value) {
  const auto read = [&]<class T>(T& own) {
    if constexpr (std::same_as<T, std::string>) {
      own = text;
      return true;
    } else if constexpr (std::same_as<T, int> || std::same_as<T, double>) {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), own);
      return error == std::errc() && end == text.data() + text.size();
    } else {
      return false;
    }
  };
  if (!std::visit(read, value)) return std::nullopt;
  return value;
}

class Interview {
 public:
  Interview(std::istream& in, std::ostream& out) : in_(in), out_(out) {}

  template <class P>
  void ask(const ParameterTable<P>& table, P& values) {
    if (!has(table.name, table.meaning)) return;
    for (const Parameter<P>& parameter : table.parameters) {
      if (value_of_sigma(table, parameter) != nullptr) continue;  // asked for with its value
      const auto* sigma = parameter_named(table, std::string(parameter.key) + "_sigma");
      out_ << '\n' << parameter.meaning << '\n';
      while (!answered(table.name, parameter, sigma, values)) {
      }
    }
  }

 private:
  // Asks whether the car has a sensor, once for the parts of its table.
  bool has(std::string_view table, std::string_view meaning) {
    if (table == table_) return has_;
    table_ = table;
    out_ << "\n[" << table << "] " << meaning << '\n';
    has_ = table == "vehicle";
    while (!has_) {
      const std::string answer = line("Is it there, y or n [n]: ", table, "being there");
      if (answer.empty() || answer == "n") break;
      has_ = answer == "y";
    }
    return has_;
  }

  template <class P>
  bool answered(std::string_view table, const Parameter<P>& parameter, const Parameter<P>* sigma,
                P& values) {
    std::string prompt = "  " + std::string(parameter.key);
    const std::string allowed = allowed_text(parameter);
    if (!allowed.empty()) prompt += ", " + allowed;
    if (sigma != nullptr) prompt += ", and its standard deviation";
    prompt += " [" + text_of(parameter.value_in(values));
    if (sigma != nullptr) prompt += " +-" + text_of(sigma->value_in(values));
    const std::string answer = line(prompt + "]: ", table, parameter.key);
    if (answer.empty()) return true;
    const std::size_t space = sigma != nullptr ? answer.find_first_of(" \t") : std::string::npos;
    const P before = values;
    if (put(parameter, answer.substr(0, space), values) &&
        (space == std::string::npos ||
         put(*sigma, std::string(trimmed(std::string_view(answer).substr(space))), values)))
      return true;
    values = before;
    return false;
  }

  template <class P>
  bool put(const Parameter<P>& parameter, const std::string& text, P& values) {
    const auto value = parsed(text, parameter.value_in(values));
    const auto problem = value ? problem_of(parameter, *value) : std::nullopt;
    if (value && !problem) {
      parameter.set(values, *value);
      return true;
    }
    out_ << "  " << parameter.key << ' '
         << (problem ? problem->text : "is not a number: '" + text + "'") << '\n';
    return false;
  }

  std::string line(const std::string& prompt, std::string_view table, std::string_view key) {
    out_ << prompt << std::flush;
    std::string text;
    if (!std::getline(in_, text)) {
      throw std::runtime_error("the answers end before '" + std::string(key) + "' of [" +
                               std::string(table) + "]; nothing is written");
    }
    return std::string(trimmed(text));
  }

  std::istream& in_;
  std::ostream& out_;
  std::string_view table_;
  bool has_ = false;
};

}  // namespace

VehicleDescription ask(std::istream& in, std::ostream& out) {
  out << "Each question has a default in brackets, which is taken where the answer is empty: then "
         "the value is not known. An answer is VALUE, or VALUE and its standard deviation.\n";
  VehicleDescription description;
  Interview interview(in, out);
  each_table([&](const auto& table, auto& values) { interview.ask(table, values); }, description);
  return description;
}

}  // namespace maploop::vehicle_tool
