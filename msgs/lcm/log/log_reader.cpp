#include "msgs/lcm/log/log_reader.h"

#include <algorithm>
#include <utility>

namespace maploop::lcm_log {
namespace {

constexpr int maximum_inside = 64;  // headers checked inside one event

bool is_channel_name(std::string_view name) {
  return std::none_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<std::uint8_t>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

// Returns whether a plausible header begins inside an event: the one with the next number, or any.
bool next_event_inside(std::span<const std::uint8_t> bytes, const LogHeader& header,
                       bool any_number) {
  bytes = bytes.first(std::min(bytes.size(), header.event_bytes() + header_bytes - 1));
  int checked = 0;
  for (std::size_t at = find_sync(bytes, 1);
       at + header_bytes <= bytes.size() && checked < maximum_inside;
       at = find_sync(bytes, at + 1)) {
    const LogHeader inside = read_header(bytes.subspan(at));
    if (implausible(inside)) continue;
    if (any_number || inside.number == header.number + 1) return true;
    ++checked;
  }
  return false;
}

}  // namespace

LogReader::Item LogReader::next() {
  if (std::exchange(event_waits_, false)) return Item::event;
  input_.skip(std::exchange(event_bytes_, 0));
  damage_ = {input_.position(), input_.position(), {}};
  while (!input_.peek(1).empty()) {
    const std::optional<std::string> wrong = check();
    if (!wrong) {
      if (damage_.reason.empty()) return Item::event;
      event_waits_ = true;
      damage_.end = event_.offset;
      return Item::damage;
    }
    if (damage_.reason.empty()) damage_.reason = *wrong;
    input_.skip(1);
    skip_to_sync();
  }
  damage_.end = input_.position();
  if (!input_.failure().empty() && !std::exchange(failure_told_, true)) {
    damage_.reason = input_.failure();
    return Item::damage;
  }
  return damage_.reason.empty() ? Item::end : Item::damage;
}

// Checks whether an event begins at the input's position; stores it in event_, or returns why not.
std::optional<std::string> LogReader::check() {
  std::span<const std::uint8_t> bytes = input_.peek(header_bytes);
  if (!begins_with_sync(bytes)) return "no event begins here";
  if (bytes.size() < header_bytes) return "the log ends inside the header of an event";
  const LogHeader header = read_header(bytes);
  const std::string name = "event " + std::to_string(header.number) + ": ";
  if (const auto wrong = implausible(header)) return name + *wrong;
  bytes = input_.peek(header.event_bytes() + header_bytes);
  if (bytes.size() < header.event_bytes()) {
    return name + "the log ends " + std::to_string(header.event_bytes() - bytes.size()) +
           " bytes before the event does";
  }
  const auto content = bytes.subspan(header_bytes);
  const auto channel_bytes = static_cast<std::size_t>(header.channel_bytes);
  event_ = {.number = header.number,
            .time_us = header.time_us,
            .channel = {reinterpret_cast<const char*>(content.data()), channel_bytes},
            .data = content.subspan(channel_bytes, static_cast<std::size_t>(header.data_bytes)),
            .offset = input_.position()};
  if (!is_channel_name(event_.channel)) return name + "its channel name cannot be printed";
  if (const auto wrong = check_what_follows(bytes, header)) return name + *wrong;
  event_bytes_ = header.event_bytes();
  return std::nullopt;
}

std::optional<std::string> LogReader::check_what_follows(std::span<const std::uint8_t> bytes,
                                                         const LogHeader& header) {
  const auto after = bytes.subspan(header.event_bytes());
  if (after.empty()) return std::nullopt;  // a wrong length hardly ends where the log does
  const bool followed = begins_with_sync(after);
  if (followed && after.size() >= header_bytes && read_header(after).number == header.number + 1) {
    return std::nullopt;
  }
  if (next_event_inside(bytes, header, !followed)) return "another event begins inside it";
  if (followed || begins_nearly_with_sync(after) || try_decode(schema_, event_.data)) {
    return std::nullopt;
  }
  return "no event follows it: its length is wrong";
}

void LogReader::skip_to_sync() {
  while (true) {
    const auto bytes = input_.peek(header_bytes);
    const std::size_t at = find_sync(bytes, 0);
    if (at < bytes.size()) return input_.skip(at);
    // The last bytes may be the start of a sync word, unless the log ends with them.
    if (bytes.size() < header_bytes) return input_.skip(bytes.size());
    input_.skip(bytes.size() - 3);
  }
}

}  // namespace maploop::lcm_log
