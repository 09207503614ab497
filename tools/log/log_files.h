// These functions open, read and describe logs for all commands that read them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "msgs/lcm/log/log_event.h"
#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

// A malicious log may have any number of channels; these are told apart. (33 MB, in `log info`.)
inline constexpr std::size_t most_channels = 1000;
// Findings and losses that are printed one by one; all are counted.
inline constexpr std::uint64_t most_printed = 1000;

// Returns the project's own types and those of other .lcm files. Throws std::runtime_error naming
// the file (and line) that cannot be read.
schema::Schema load_types(std::span<const std::filesystem::path> files);

struct LogSummary {
  std::uint64_t bytes = 0;  // uncompressed
  std::uint64_t events = 0;
  std::uint64_t damages = 0, damaged_bytes = 0;
};

// Reads a whole log, plain or .gz, with a progress line; damage is counted, and given to `damage`.
// Throws std::runtime_error naming the file if it cannot be read.
LogSummary read_log(const std::filesystem::path& file, const schema::Schema& schema,
                    const std::function<void(const LogEvent&)>& event,
                    const std::function<void(const Damage&)>& damage = {});

// Returns why a message of known type does not decode, or nothing.
std::optional<std::string> why_undecodable(const LogEvent& event, const schema::Schema& schema);

// Throws std::invalid_argument if `output` is the same file as `input`.
void refuse_same_file(const std::filesystem::path& input, const std::filesystem::path& output);

// Returns for instance "2011-09-26 13:10:51.175862", or "123 us" outside of the years 1970 to 2200.
std::string time_text(std::int64_t time_us);

// Returns for instance "1.4 MB".
std::string size_text(std::uint64_t bytes);

// Returns b - a in seconds: the nearest double (0.05 for 50000 us) for the years 1684 to 2255,
// without overflow outside of them.
double seconds_between(std::int64_t a_us, std::int64_t b_us);

}  // namespace maploop::lcm_log
