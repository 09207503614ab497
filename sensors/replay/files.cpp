#include "sensors/replay/files.h"

#include <stdexcept>

#include "msgs/trimmed.h"
#include "sensors/number.h"

namespace maploop::sensors {

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(trimmed(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

std::vector<double> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (!(text = trimmed(text)).empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(white_space));
    const auto number = parse_number<double>(word.starts_with('+') ? word.substr(1) : word);
    if (!number) {
      throw std::invalid_argument("column " + std::to_string(numbers.size() + 1) +
                                  " is not a finite number: " + quoted(word));
    }
    numbers.push_back(*number);
    text.remove_prefix(word.size());
  }
  return numbers;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string shown = "'";
  for (const char c : text.substr(0, longest)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > longest ? "...'" : "'");
}

std::string numbered_file(std::size_t index, std::string_view extension) {
  constexpr std::size_t digits = 10;
  std::string number = std::to_string(index);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return number.append(extension);
}

}  // namespace maploop::sensors
