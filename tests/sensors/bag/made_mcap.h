// Makes the records of MCAP files.
#pragma once

#include <cstdint>
#include <string>

namespace maploop::made_mcap {

template <class Number>
std::string field(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}
inline std::string text(const std::string& value) {
  return field(static_cast<std::uint32_t>(value.size())) + value;
}
inline std::string record(char op, const std::string& content) {
  return op + field(std::uint64_t{content.size()}) + content;
}
inline std::string channel(std::uint16_t id, const std::string& topic,
                           const std::string& encoding) {
  return record(4, field(id) + field(id) + text(topic) + text(encoding) + text(""));
}
inline std::string schema(std::uint16_t id, const std::string& name, const std::string& encoding,
                          const std::string& definition = "the definition") {
  return record(3, field(id) + text(name) + text(encoding) + text(definition));
}
inline std::string message(std::uint16_t channel, std::uint64_t time, const std::string& data) {
  return record(5, field(channel) + field(std::uint32_t{0}) + field(time) + field(time) + data);
}
inline std::string file(const std::string& records) {
  const std::string magic = "\x89MCAP0\r\n";
  return magic + record(1, text("") + text("maker")) + records + record(15, std::string(4, '\0')) +
         record(2, std::string(20, '\0')) + magic;
}
}  // namespace maploop::made_mcap
