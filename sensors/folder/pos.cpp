// Reads the solutions of RTKLIB (manual 2.4.2, appendix B.1), which other programs write too.
#include <algorithm>
#include <optional>
#include <stdexcept>

#include "msgs/time.h"
#include "sensors/folder/number_table.h"
#include "sensors/number.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t,;");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t,;"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

// Returns the columns of "%  GPST  latitude(deg) longitude(deg) ...", or nothing for another
// comment.
std::vector<std::string> heading_of(std::string_view comment) {
  const auto words = words_of(comment.substr(1));
  if (words.size() < 4 || (words[0] != "GPST" && words[0] != "UTC")) return {};
  std::vector<std::string> columns;
  for (const std::string_view word : words) columns.emplace_back(word.substr(0, word.find('(')));
  if (comment.find("(d'\")") != std::string_view::npos)
    throw std::invalid_argument("has angles in degrees, minutes and seconds: write degrees");
  return columns;
}

// Returns seconds from 1970 in the scale of the file, of "2019/06/08 08:03:55.500" or of a GPS week
// and a second.
double seconds_of(std::string_view first, std::string_view second) {
  if (first.find('/') != std::string_view::npos) {
    std::string stamp(first);
    std::ranges::replace(stamp, '/', '-');
    return to_seconds(parse_time(stamp + ' ' + std::string(second)).time_since_epoch());
  }
  const auto week = parse_number<int>(first);
  const auto tow = parse_number<double>(second);
  constexpr double gps_epoch = 315964800.0, week_length = 604800.0;
  if (!week || !tow || *week < 0 || *week > 10000)
    throw std::invalid_argument("has neither a date and time nor a GPS week and second");
  return gps_epoch + week_length * *week + *tow;
}

}  // namespace

NumberCells parse_pos(std::string_view content) {
  NumberCells cells;
  const auto lines = split_lines(content);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    try {
      if (lines[i].empty()) continue;
      if (lines[i].front() == '%') {
        if (cells.columns.empty()) cells.columns = heading_of(lines[i]);
        continue;
      }
      if (cells.columns.empty())
        throw std::invalid_argument("has no heading '% GPST latitude(deg) ...' above its rows");
      const auto words = words_of(lines[i]);
      if (words.size() != cells.columns.size() + 1) {
        throw std::invalid_argument("has " + std::to_string(words.size()) +
                                    " words, but the heading has " +
                                    std::to_string(cells.columns.size() + 1));
      }
      cells.values.push_back(seconds_of(words[0], words[1]));
      for (std::size_t k = 2; k < words.size(); ++k) {
        const auto number = parse_number<double>(words[k]);
        if (!number) throw std::invalid_argument("is not a number: " + quoted(words[k]));
        cells.values.push_back(*number);
      }
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument("line " + std::to_string(i + 1) + ": " + e.what());
    }
  }
  if (cells.columns.empty()) throw std::invalid_argument("has no heading of RTKLIB's solutions");
  return cells;
}

}  // namespace maploop::sensors
