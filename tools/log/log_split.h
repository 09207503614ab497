// Extracts a part of a log, or splits a log into pieces.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/lcm/schema.h"
#include "tools/log/channel_filter.h"

namespace maploop::lcm_log {

// The maximum size of a piece; exactly one of both is set.
struct PieceLimit {
  std::optional<double> seconds;  // of log time, counted from the first event taken
  std::optional<std::uint64_t> bytes;
};

// Parses "90s", "5min", "1h", "500kB", "100MB" or "2GB" (powers of ten). Throws
// std::invalid_argument naming the text if it has another form, or is below 1 ms or 100 bytes.
PieceLimit parse_piece_limit(const std::string& text);

struct SplitParameters {
  std::optional<double> start_s;  // since the log's first event, inclusive
  std::optional<double> end_s;    // since the log's first event, exclusive
  ChannelFilter channels;
  std::optional<PieceLimit> every;  // empty: one file
  std::filesystem::path output;  // pieces: "out.lcmlog" gives out.000.lcmlog, out.001.lcmlog, ...
};

struct SplitResult {
  std::uint64_t events_read = 0, events_taken = 0;
  std::uint64_t damages = 0, damaged_bytes = 0;  // left out
  std::vector<std::filesystem::path> files;
};

// A piece contains at least one event; times without events have no piece. An event that is
// slightly earlier than its predecessor stays in the same piece. Throws std::runtime_error if a
// file cannot be read or written, if no event is selected, or for more than 10,000 pieces;
// std::invalid_argument if the output is the log itself.
SplitResult split(const std::filesystem::path& log, const schema::Schema& schema,
                  SplitParameters parameters);

}  // namespace maploop::lcm_log
