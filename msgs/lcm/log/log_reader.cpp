#include "msgs/lcm/log/log_reader.h"

#include <algorithm>
#include <utility>

namespace maploop::lcm_log {
namespace {

constexpr std::size_t kSearchBytes = 1 << 20;   // how far beyond an event the next one is searched
constexpr int kMaximumInside = 64;              // headers checked inside one event
constexpr std::size_t kMaximumChannels = 1000;  // remembered; a hostile log may have any number

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_channel_name(std::string_view name) {
  return std::none_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<std::uint8_t>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

// Returns where the first plausible header begins, at or after `from`; bytes.size() if there is
// none.
std::size_t find_header(std::span<const std::uint8_t> bytes, std::size_t from,
                        const LogLimits& limits) {
  for (std::size_t at = find_sync(bytes, from); at + kHeaderBytes <= bytes.size();
       at = find_sync(bytes, at + 1)) {
    if (!implausible(read_header(bytes.subspan(at)), limits)) return at;
  }
  return bytes.size();
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& file, const schema::Schema& schema,
                     const LogLimits& limits)
    : schema_(schema), limits_(limits), input_(file) {}

LogReader::Item LogReader::next() {
  if (std::exchange(event_waits_, false)) return Item::event;
  input_.skip(std::exchange(event_bytes_, 0));
  damage_ = {input_.position(), input_.position(), {}};
  while (!input_.peek(1).empty()) {
    const std::optional<std::string> wrong = check();
    if (!wrong) {
      remember();
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
  std::span<const std::uint8_t> bytes = input_.peek(kHeaderBytes);
  if (!begins_with_sync(bytes)) return "no event begins here";
  if (bytes.size() < kHeaderBytes) return "the log ends inside the header of an event";
  const LogHeader header = read_header(bytes);
  const std::string name = "event " + std::to_string(header.number) + ": ";
  if (const auto wrong = implausible(header, limits_)) return name + *wrong;
  bytes = input_.peek(header.event_bytes() + kHeaderBytes);
  if (bytes.size() < header.event_bytes()) {
    return name + "the log ends " + std::to_string(header.event_bytes() - bytes.size()) +
           " bytes before the event does";
  }
  event_ = {.number = header.number, .time_us = header.time_us, .offset = input_.position()};
  event_.channel =
      as_text(bytes.subspan(kHeaderBytes, static_cast<std::size_t>(header.channel_bytes)));
  if (!is_channel_name(event_.channel)) return name + "its channel name cannot be printed";
  if (const auto wrong = check_what_follows(bytes, header)) return name + *wrong;

  bytes = input_.peek(header.event_bytes());  // looking ahead may have moved the window
  const auto channel_bytes = static_cast<std::size_t>(header.channel_bytes);
  event_.channel = as_text(bytes.subspan(kHeaderBytes, channel_bytes));
  event_.data =
      bytes.subspan(kHeaderBytes + channel_bytes, static_cast<std::size_t>(header.data_bytes));
  event_bytes_ = header.event_bytes();
  return std::nullopt;
}

std::optional<std::string> LogReader::check_what_follows(std::span<const std::uint8_t> bytes,
                                                         const LogHeader& header) {
  const auto after = bytes.subspan(header.event_bytes());
  const bool followed = begins_with_sync(after);
  if (followed && after.size() >= kHeaderBytes && read_header(after).number == header.number + 1) {
    return std::nullopt;
  }
  if (next_event_inside(bytes, header, !followed)) return "another event begins inside it";
  if (followed || begins_nearly_with_sync(after)) return std::nullopt;
  const auto ahead = input_.peek(header.event_bytes() + kSearchBytes);
  const std::size_t looked_at = std::min(ahead.size(), header.event_bytes() + kSearchBytes);
  event_.doubtful = true;
  if (trusted(ahead.first(looked_at), header)) return std::nullopt;
  return "no event follows it: its length is wrong";
}

// Returns whether a plausible header begins inside this event: the one with the next number, or
// any.
bool LogReader::next_event_inside(std::span<const std::uint8_t> bytes, const LogHeader& header,
                                  bool any_number) const {
  const auto inside = bytes.first(std::min(bytes.size(), header.event_bytes() + kHeaderBytes - 1));
  std::size_t at = find_header(inside, kSyncWordBytes, limits_);
  for (int i = 0; i < kMaximumInside && at < header.event_bytes(); ++i) {
    if (any_number || read_header(inside.subspan(at)).number == header.number + 1) return true;
    at = find_header(inside, at + 1, limits_);
  }
  return false;
}

// Returns whether the length of an event is right although no other event follows directly.
bool LogReader::trusted(std::span<const std::uint8_t> bytes, const LogHeader& header) {
  const auto channel_bytes = static_cast<std::size_t>(header.channel_bytes);
  const auto data =
      bytes.subspan(kHeaderBytes + channel_bytes, static_cast<std::size_t>(header.data_bytes));
  const std::uint64_t fingerprint = schema::fingerprint_of(data);
  if (const schema::Type* type = schema_.find(fingerprint)) return !decoded_.decode(*type, data);

  const auto seen = seen_.find(std::string(as_text(bytes.subspan(kHeaderBytes, channel_bytes))));
  if (seen != seen_.end() && seen->second.fingerprint == fingerprint &&
      seen->second.bytes == data.size()) {
    return true;
  }
  const std::size_t following = find_header(bytes, header.event_bytes(), limits_);
  if (following == bytes.size()) return false;
  return read_header(bytes.subspan(following)).number != header.number + 1;
}

void LogReader::skip_to_sync() {
  while (true) {
    const auto bytes = input_.peek(kHeaderBytes);
    const std::size_t at = find_sync(bytes, 0);
    if (at < bytes.size()) return input_.skip(at);
    // The last bytes may be the start of a sync word, unless the log ends with them.
    if (bytes.size() < kHeaderBytes) return input_.skip(bytes.size());
    input_.skip(bytes.size() - (kSyncWordBytes - 1));
  }
}

void LogReader::remember() {
  if (event_.data.size() < 8) return;
  channel_ = event_.channel;
  const auto found = seen_.find(channel_);
  if (found == seen_.end() && seen_.size() >= kMaximumChannels) return;
  Seen& seen = found == seen_.end() ? seen_[channel_] : found->second;
  seen = {schema::fingerprint_of(event_.data), event_.data.size()};
}

}  // namespace maploop::lcm_log
