#include "tools/spy/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

// Returns the path of an array without indices: "covariance" for "covariance[0][0]".
std::string array_path(const schema::DecodedMessage& message, std::size_t node) {
  std::string path = message.path(node);
  if (message.nodes()[node].count > 0) {
    path.resize(path.size() - message.sizes(node).size() * std::string_view("[0]").size());
  }
  return path;
}

std::string array_line(const schema::DecodedMessage& message, std::size_t node) {
  const std::uint32_t count = message.nodes()[node].count;
  std::string line = array_path(message, node);
  for (const std::uint32_t size : message.sizes(node)) line += '[' + std::to_string(size) + ']';
  line += " =";
  for (std::uint32_t i = 0; i < std::min<std::size_t>(count, shown_values); ++i) {
    line += ' ' + message.text(node, i);
  }
  if (count > shown_values) line += " ...";
  return line;
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
  std::string line =
      fmt::format("{:18} {:30} {:>8} {:>9} {:>9} {:>8} {:>8} {:>8} {:>6} {:>6}", "CHANNEL", "TYPE",
                  "COUNT", "RATE_HZ", "JITTER_MS", "AGE_S", "SILENT_S", "BYTES", "LOST", "BAD");
  return line;
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
  schema::DecodedMessage message;
  if (const auto error = message.decode(*type, bytes)) {
    return {"not as " + type->name + " says, at byte " + std::to_string(error->offset) + ": " +
            error->reason};
  }
  std::vector<std::string> lines;
  for (std::size_t n = 1; n < message.nodes().size() && lines.size() < shown_lines; ++n) {
    const bool array = !message.sizes(n).empty();
    const bool below = message.nodes()[n].end > n + 1;
    if (array && !below) {
      lines.push_back(array_line(message, n));
    } else if (message.nodes()[n].count == 1) {
      lines.push_back(message.path(n) + " = " + message.text(n));
    }
  }
  return lines;
}

}  // namespace maploop::spy
