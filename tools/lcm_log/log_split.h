// A part of a log, or a log in pieces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/lcm/schema.h"
#include "tools/lcm_log/channel_filter.h"

namespace maploop::lcm_log {

// How large a piece may become; exactly one of both.
struct PieceLimit {
  std::optional<double> seconds;  // of log time, counted from the first event taken
  std::optional<std::uint64_t> bytes;
};

// "90s", "5min", "1h", "500kB", "100MB", "2GB" (powers of ten). Throws std::invalid_argument naming
// the text when it is none of these, or below 1 ms or 100 bytes.
PieceLimit parse_piece_limit(const std::string& text);

struct SplitParameters {
  std::optional<double> start_s;  // since the log's first event, included
  std::optional<double> end_s;    // since the log's first event, left out
  ChannelFilter channels;
  std::optional<PieceLimit> every;  // empty: one file
  std::filesystem::path output;  // pieces: "out.lcmlog" gives out.000.lcmlog, out.001.lcmlog, ...
};

struct SplitResult {
  std::uint64_t events_read = 0, events_taken = 0;
  std::uint64_t damages = 0, damaged_bytes = 0;  // left out
  std::vector<std::filesystem::path> files;
};

// A piece holds at least one event; there is none for a time without events. An event that is a
// little earlier than the one before stays in its piece. Throws std::runtime_error when a file
// cannot be read or written, when no event is taken, or for more than 10,000 pieces;
// std::invalid_argument when the output is the log itself.
SplitResult split(const std::filesystem::path& log, const schema::Schema& schema,
                  SplitParameters parameters);

}  // namespace maploop::lcm_log
