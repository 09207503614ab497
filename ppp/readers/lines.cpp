#include "ppp/readers/lines.h"

#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>

namespace maploop::ppp {

namespace {

struct Close {
  void operator()(gzFile file) const { gzclose(file); }
};
using File = std::unique_ptr<gzFile_s, Close>;

File open(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path))
    throw ReadError(path.string() + ": is a folder; name its files");
  File file(gzopen(path.c_str(), "rb"));
  if (!file) throw ReadError(path.string() + ": cannot be read (" + std::strerror(errno) + ")");
  return file;
}

[[noreturn]] void fail_as_damaged(const std::filesystem::path& path, const File& file) {
  int code = 0;
  throw ReadError(path.string() + ": damaged gzip data (" + gzerror(file.get(), &code) + ")");
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  constexpr std::size_t largest = std::size_t{2} << 30U;
  const File file = open(path);
  gzbuffer(file.get(), 1U << 17U);
  std::string text;
  for (;;) {
    const std::size_t had = text.size();
    text.resize(had + (had < (1U << 20U) ? 1U << 20U : had));
    const auto room = static_cast<unsigned>(std::min<std::size_t>(text.size() - had, 1U << 30U));
    const int got = gzread(file.get(), text.data() + had, room);
    if (got < 0) fail_as_damaged(path, file);
    text.resize(had + static_cast<std::size_t>(got));
    if (text.size() > largest) throw ReadError(path.string() + ": larger than 2 GB");
    if (static_cast<unsigned>(got) < room) break;
  }
  int code = 0;
  gzerror(file.get(), &code);
  if (code != Z_OK) fail_as_damaged(path, file);
  return text;
}

std::string read_head(const std::filesystem::path& path) {
  const File file = open(path);
  std::string text(4096, '\0');
  const int got = gzread(file.get(), text.data(), static_cast<unsigned>(text.size()));
  if (got < 0) fail_as_damaged(path, file);
  text.resize(static_cast<std::size_t>(got));
  return text;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<double> parse_number(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  if (text.empty() || text.size() > 40 || text[0] == '+') return {};
  std::array<char, 40> copy{};
  const char* begin = text.data();
  // from_chars knows no D.
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
         std::to_string(first + 1) + " is no " + what);
  }
  return *value;
}

int Lines::integer(std::size_t first, std::size_t width, const char* what) const {
  const auto value = parse_integer(column(first, width));
  if (!value) {
    fail(std::string("'") + std::string(column(first, width)) + "' in column " +
         std::to_string(first + 1) + " is no " + what);
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
    if (at == std::string_view::npos) lines.fail("a date and time is missing or cut");
    const auto end = std::min(text.find(' ', at), text.size());
    const auto value = parse_number(text.substr(at, end - at));
    const bool is_second = &part == &parts.back();
    if (!value || std::abs(*value) > 9999.0 || (!is_second && *value != std::floor(*value))) {
      lines.fail("'" + std::string(text.substr(at, end - at)) + "' is no part of a date and time");
    }
    part = *value;
    at = end;
  }
  if (!blank(columns(text, at, text.size()))) {
    lines.fail("'" + std::string(text) + "' is no date and time");
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
