#include "sensors/folder/stamps.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "msgs/input_limits.h"
#include "sensors/number.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t latest = 7258118400;  // s, the year 2200

// Seconds with a point, digit by digit: a double of a stamp of today is exact to 0.2 us only.
std::optional<Time> exact_seconds(std::string_view text) {
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos) return std::nullopt;
  const auto whole = parse_number<std::int64_t>(text.substr(0, point));
  std::string fraction(text.substr(point + 1, 9));
  const std::string_view all = text.substr(point + 1);
  if (!whole || *whole < 0 || text.starts_with('-') || *whole > latest || all.empty() ||
      all.find_first_not_of("0123456789") != std::string_view::npos)
    return std::nullopt;
  fraction.resize(9, '0');
  return Time(std::chrono::seconds(*whole) + Duration(*parse_number<std::int64_t>(fraction)));
}

std::optional<Time> whole_stamp(std::string_view text) {
  const auto number = parse_number<std::int64_t>(text);
  if (!number || *number < 100'000'000) return std::nullopt;
  std::int64_t unit = 1;  // ns
  for (const std::int64_t least : {100'000'000'000'000'000, 100'000'000'000'000, 100'000'000'000}) {
    if (*number >= least) break;
    unit *= 1000;
  }
  if (*number > latest * 1'000'000'000 / unit) return std::nullopt;
  return Time(Duration(*number * unit));
}

std::optional<Time> calendar_stamp(std::string_view text) {
  if (text.find(':') == std::string_view::npos) return std::nullopt;
  try {
    return parse_time(text);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

std::optional<Time> plain_seconds(std::string_view text) {
  const auto seconds = parse_number<double>(text);
  if (!seconds) return std::nullopt;
  try {
    return Time(checked_seconds(*seconds));
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

// Returns the first word, and removes it and the separators behind it from the text.
std::string_view next_word(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of(" \t,"), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(text.find_first_not_of(" \t,", end), text.size()));
  return word;
}

std::optional<Time> stamp_of_line(std::string_view line) {
  if (const auto stamp = calendar_stamp(line)) return stamp;
  std::string_view rest = line;
  std::string_view word = next_word(rest);
  if (!rest.empty()) word = next_word(rest);
  if (const auto stamp = stamp_of(word)) return stamp;
  return plain_seconds(word);
}

// Returns the name without its extension, of which .gz is a part.
std::string stem_of(const fs::path& name) {
  return (name.extension() == ".gz" ? name.stem() : name).stem().string();
}

}  // namespace

std::optional<Time> stamp_of(std::string_view text) {
  if (const auto stamp = exact_seconds(text)) return stamp;
  if (const auto stamp = whole_stamp(text)) return stamp;
  return calendar_stamp(text);
}

std::vector<Time> read_times(const fs::path& file) {
  const std::string text = read_text(file);
  std::vector<Time> stamps;
  std::size_t number = 0;
  for (const std::string_view line : split_lines(text)) {
    const std::string place = file.string() + ':' + std::to_string(++number) + ": ";
    if (line.starts_with('#')) continue;
    const auto stamp = stamp_of_line(line);
    if (!stamp) {
      throw std::runtime_error(place + quoted(line) +
                               " is neither seconds nor YYYY-MM-DD hh:mm:ss.fraction");
    }
    if (!stamps.empty() && *stamp <= stamps.back())
      throw std::runtime_error(place + "the stamps do not increase");
    stamps.push_back(*stamp);
  }
  return stamps;
}

std::vector<std::string> files_of_kind(const fs::path& folder,
                                       std::initializer_list<std::string_view> extensions) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path name = entry->path().filename();
    const auto kind = (name.extension() == ".gz" ? name.stem() : name).extension().string();
    if (std::ranges::find(extensions, kind) != extensions.end()) names.push_back(name.string());
    if (names.size() > input_limits::frames) {
      throw std::runtime_error("'" + folder.string() + "' has more than " +
                               std::to_string(input_limits::frames) + " files; cut the recording");
    }
  }
  std::ranges::sort(names, [](const std::string& a, const std::string& b) {
    return strverscmp(a.c_str(), b.c_str()) < 0;
  });
  return names;
}

std::optional<std::vector<Time>> stamps_in_names(const std::vector<std::string>& names) {
  std::vector<Time> stamps;
  for (const std::string& name : names) {
    const auto stamp = stamp_of(stem_of(name));
    if (!stamp || (!stamps.empty() && *stamp <= stamps.back())) return std::nullopt;
    stamps.push_back(*stamp);
  }
  return stamps;
}

std::optional<fs::path> times_file(const fs::path& folder) {
  std::error_code ignored;
  for (const char* name : {"timestamps.txt", "times.txt"})
    if (fs::is_regular_file(folder / name, ignored)) return folder / name;
  return std::nullopt;
}

}  // namespace maploop::sensors
