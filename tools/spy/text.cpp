#include "tools/spy/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "msgs/lcm/decoded_message.h"

namespace maploop::spy {
namespace {

using nlohmann::json;

constexpr std::size_t shown_values = 8;
constexpr std::size_t shown_lines = 2000;

std::string number(const std::optional<double>& value, double unit, int digits) {
  if (!value) return "-";
  return fmt::format("{:.{}f}", *value * unit, digits);
}

json nullable(const auto& value) {
  return value ? json(*value) : json(nullptr);
}

// Appends a line for each field with values of its own, and for each empty array.
void add_lines(const schema::Field& field, const std::string& path,
               std::vector<std::string>& lines) {
  if (lines.size() >= shown_lines) return;
  const std::size_t count = field.count();
  if (count > 0 || (!field.sizes.empty() && field.inner.empty())) {
    std::string line = path;
    for (const std::size_t size : field.sizes) line += '[' + std::to_string(size) + ']';
    line += " =";
    for (std::size_t i = 0; i < std::min(count, shown_values); ++i) line += ' ' + field.text(i);
    lines.push_back(line + (count > shown_values ? " ..." : ""));
  }
  for (std::size_t i = 0; i < field.inner.size(); ++i) {
    add_lines(field.inner[i], inner_path(field, i, path), lines);
  }
}

// Returns a name without spaces, so that it stays one column.
std::string one_word(std::string_view name) {
  std::string word = printable(name);
  std::replace(word.begin(), word.end(), ' ', '?');
  return word.empty() ? "?" : word;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    const auto byte = static_cast<std::uint8_t>(c);
    if (byte < 0x20 || byte == 0x7f) c = '?';
  }
  return result;
}

std::string table_header() {
  return fmt::format("{:18} {:30} {:>8} {:>9} {:>9} {:>8} {:>8} {:>8} {:>6} {:>6}", "CHANNEL",
                     "TYPE", "COUNT", "RATE_HZ", "JITTER_MS", "AGE_S", "SILENT_S", "BYTES", "LOST",
                     "BAD");
}

std::string table_row(const ChannelStatus& s) {
  return fmt::format("{:18} {:30} {:8} {:>9} {:>9} {:>8} {:8.2f} {:8} {:>6} {:6}", one_word(s.name),
                     one_word(s.type), s.count, number(s.rate_hz, 1.0, 2),
                     number(s.jitter_s, 1e3, 3), number(s.age_s, 1.0, 3), s.silent_s, s.bytes,
                     s.lost ? std::to_string(*s.lost).c_str() : "-", s.bad);
}

std::string json_row(const ChannelStatus& s) {
  const json row = {{"channel", s.name},
                    {"type", s.type},
                    {"count", s.count},
                    {"rate_hz", nullable(s.rate_hz)},
                    {"jitter_s", nullable(s.jitter_s)},
                    {"age_s", nullable(s.age_s)},
                    {"silent_s", s.silent_s},
                    {"bytes", s.bytes},
                    {"lost", nullable(s.lost)},
                    {"bad", s.bad}};
  return row.dump(-1, ' ', true, json::error_handler_t::replace);
}

std::vector<std::string> field_lines(const schema::Schema& schema,
                                     std::span<const std::uint8_t> bytes) {
  const schema::Type* type = schema.find(schema::fingerprint_of(bytes));
  if (type == nullptr) return {"nobody has declared this type; --types FILE.lcm does"};
  std::vector<std::string> lines;
  try {
    add_lines(decode(*type, bytes), "", lines);
  } catch (const schema::DecodeError& e) {
    lines = {
        fmt::format("it does not decode as {}, at byte {}: {}", type->name, e.offset(), e.what())};
  }
  return lines;
}

}  // namespace maploop::spy
