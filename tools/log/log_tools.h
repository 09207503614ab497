// What the subcommands of `maploop log` do. They read plain and .gz logs, write a .gz log if its
// name ends so, and print to `out`. Each throws std::runtime_error naming the file that cannot be
// read or written, and std::invalid_argument if an output is one of the inputs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>

#include "msgs/lcm/schema.h"
#include "tools/log/channel_filter.h"
#include "tools/log/log_files.h"

namespace maploop::lcm_log {

using std::filesystem::path;

// Prints the channels of a log with their types, rates, intervals and gaps. Intervals are between
// the log times of consecutive messages of a channel; a gap is an interval above 2.5 times the
// median, which is at most 0.8 % too long. Writes the same as JSON unless `json` is empty. Throws
// if the file contains bytes but no event.
void info(const path& log, const schema::Schema& schema, const path& json, std::ostream& out);

struct Verification {
  std::uint64_t events = 0;
  std::uint64_t decoded = 0;  // messages of known type, read to their last byte
  std::uint64_t unknown = 0;  // messages of unknown types, which are not decoded
  std::uint64_t findings = 0;
};

// Prints damage, event numbers that do not increase by one, times that go back within a channel
// (threads may log in another order than that of their data), and messages of known type that do
// not decode: the first thousand findings.
Verification verify(const path& log, const schema::Schema& schema, std::ostream& out);

struct Recovery {
  std::uint64_t events = 0;  // written
  std::uint64_t losses = 0, lost_bytes = 0;
  std::uint64_t lost_events = 0;  // as far as event numbers show
};

// Writes everything readable of a damaged log, and prints what is lost: bytes that are not an
// event, and messages of known type that do not decode. Events are numbered again from 0. Throws
// if no event is found.
Recovery recover(const path& log, const schema::Schema& schema, const path& output,
                 std::ostream& out);

// Writes the events of a black box (--black-box), from the first snapshot on that has enough of
// them before it, and that snapshot beside the log, from which a replay goes on with the run's own
// bits. The whole log, if the run's first event is there. Prints what it wrote, and how to replay
// it.
void black_box(const path& box, const schema::Schema& schema, const path& output,
               std::ostream& out);

// The maximum size of a piece: bytes, or seconds of log time, counted from the first event taken.
struct PieceLimit {
  double most = 0.0;
  bool is_time = false;
};

// Parses "90s", "5min", "1h", "500kB", "100MB" or "2GB" (powers of ten). Throws
// std::invalid_argument naming the text if it has another form, or is below 1 ms or 100 bytes.
PieceLimit parse_piece_limit(const std::string& text);

struct SplitParameters {
  std::optional<double> start_s = {};    // since the log's first event, inclusive
  std::optional<double> end_s = {};      // since the log's first event, exclusive
  ChannelFilter channels = {};           // empty: every channel
  std::optional<PieceLimit> every = {};  // empty: one file
  path output = {};  // pieces: "out.lcmlog" gives out.000.lcmlog, out.001.lcmlog, ...
};

// Writes a part of a log, or a log in pieces, without its damage. A piece contains at least one
// event; times without events have no piece. An event that is slightly earlier than its predecessor
// stays in the same piece. The last calibration before a part or a piece, which is needed to replay
// it, is written at its beginning, unless its channel is not selected. Throws if no event is
// selected, or for more than 10,000 pieces.
LogSummary split(const path& log, const schema::Schema& schema, const SplitParameters& parameters,
                 std::ostream& out);

// Writes the messages in the format that the name of the output says (log_writer.h); a bag is
// compressed by "none", "lz4" or "bz2". Times are those of the log. Throws if there is no message.
LogSummary convert(const path& log, const schema::Schema& schema, const path& output,
                   const std::string& bag_compression, std::ostream& out);

// Writes always the earliest of the logs' next events; among equally early ones that of the log
// named first. The order inside each log is therefore kept, even if its own times go back. Damage
// is left out.
LogSummary merge(std::span<const path> logs, const schema::Schema& schema, const path& output,
                 std::ostream& out);

// Returns whether the messages on the selected channels are the same; prints for each channel the
// first message and field that differ. The n-th message of a channel is the partner of the n-th
// message of that channel in the other log. Only data is compared, not log time or the order
// between channels. Each log is read twice; memory is 8 bytes a message, which are compared by a
// 64-bit hash (XXH3). Throws if a log is damaged or has more than 50 million messages, and if no
// message was compared.
bool diff(const path& a, const path& b, const schema::Schema& schema, const ChannelFilter& channels,
          std::ostream& out);

// The first difference between two messages: a field by its path, "type", or "byte N" of messages
// that cannot be decoded by a known type.
struct FieldDifference {
  std::string field;
  std::string a, b;  // the field's values
};

// Returns nothing if the messages have the same bytes.
std::optional<FieldDifference> compare(std::span<const std::uint8_t> a,
                                       std::span<const std::uint8_t> b,
                                       const schema::Schema& schema);

}  // namespace maploop::lcm_log
