#include "ppp/readers/files/lines.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"

namespace maploop::ppp {

namespace {

template <class Read>
std::string or_read_error(Read read) {
  try {
    return read();
  } catch (const FileError& error) {
    throw ReadError(error.what());
  }
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  return or_read_error([&] { return read_text(path, input_limits::gnss_file); });
}

std::string read_head(const std::filesystem::path& path) {
  return or_read_error([&] { return maploop::read_head(path, 65536); });
}

std::optional<double> parse_number(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  if (text.empty() || text.size() > 40 || text[0] == '+') return {};
  std::array<char, 40> copy{};
  const char* begin = text.data();
  // from_chars does not accept the exponent D.
  if (const auto d = text.find_first_of("Dd"); d != std::string_view::npos) {
    std::memcpy(copy.data(), text.data(), text.size());
    copy[d] = 'E';
    begin = copy.data();
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, begin + text.size(), value);
  if (error != std::errc{} || end != begin + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<int> parse_integer(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

bool Lines::next() {
  if (at_ >= text_.size()) {
    line_ = {};
    return false;
  }
  const auto end = text_.find('\n', at_);
  whole_ = end != std::string_view::npos;
  line_ = text_.substr(at_, whole_ ? end - at_ : std::string_view::npos);
  at_ = whole_ ? end + 1 : text_.size();
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++line_number_;
  return true;
}

std::string_view Lines::peek() const {
  return text_.substr(at_, text_.find('\n', at_) - at_);
}

double Lines::number(std::size_t first, std::size_t width, const char* what) const {
  const auto value = parse_number(column(first, width));
  if (!value) {
    fail(std::string("'") + std::string(column(first, width)) + "' in column " +
         std::to_string(first + 1) + " is not a valid " + what);
  }
  return *value;
}

int Lines::integer(std::size_t first, std::size_t width, const char* what) const {
  const auto value = parse_integer(column(first, width));
  if (!value) {
    fail(std::string("'") + std::string(column(first, width)) + "' in column " +
         std::to_string(first + 1) + " is not a valid " + what);
  }
  return *value;
}

double Lines::number_or(std::size_t first, std::size_t width, double otherwise,
                        const char* what) const {
  return blank(column(first, width)) ? otherwise : number(first, width, what);
}

int Lines::integer_or(std::size_t first, std::size_t width, int otherwise, const char* what) const {
  return blank(column(first, width)) ? otherwise : integer(first, width, what);
}

void Lines::fail(const std::string& what) const {
  throw ReadError(file_ + ":" + std::to_string(line_number_) + ": " + what);
}

GpsTime parse_stamp(const Lines& lines, std::string_view text) {
  std::array<double, 6> parts{};
  std::size_t at = 0;
  for (double& part : parts) {
    at = text.find_first_not_of(' ', at);
    if (at == std::string_view::npos) lines.fail("a date and time is missing or incomplete");
    const auto end = std::min(text.find(' ', at), text.size());
    const auto value = parse_number(text.substr(at, end - at));
    const bool is_second = &part == &parts.back();
    if (!value || std::abs(*value) > 9999.0 || (!is_second && *value != std::floor(*value))) {
      lines.fail("'" + std::string(text.substr(at, end - at)) +
                 "' is not a valid part of a date and time");
    }
    part = *value;
    at = end;
  }
  if (!blank(columns(text, at, text.size()))) {
    lines.fail("'" + std::string(text) + "' is not a date and time; expected six numbers");
  }
  int year = static_cast<int>(parts[0]);
  if (year < 100) year += year < 80 ? 2000 : 1900;
  try {
    return gps_time({year, static_cast<int>(parts[1]), static_cast<int>(parts[2]),
                     static_cast<int>(parts[3]), static_cast<int>(parts[4]), parts[5]});
  } catch (const std::invalid_argument& error) {
    lines.fail("'" + std::string(trimmed(text)) + "' is " + error.what());
  }
}

}  // namespace maploop::ppp
