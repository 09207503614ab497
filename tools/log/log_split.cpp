#include <fmt/ostream.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/log/log_header.h"
#include "tools/log/log_tools.h"
#include "tools/log/log_writer.h"

namespace maploop::lcm_log {
namespace {

constexpr std::size_t most_pieces = 10'000;

// Returns for instance "out.012.lcmlog.gz" for "out.lcmlog.gz".
path piece_name(path output, std::size_t number) {
  const std::string gz = output.extension() == ".gz" ? ".gz" : "";
  if (!gz.empty()) output.replace_extension();
  const std::string extension = output.extension().string();
  return output.replace_extension(fmt::format("{:03}{}{}", number, extension, gz));
}

class Pieces {
 public:
  Pieces(const SplitParameters& parameters, const path& log, const schema::Schema& schema)
      : parameters_(parameters), log_(log), schema_(schema) {}

  // Keeps the calibration, which each piece begins with: without it a piece cannot be replayed.
  void remember(const LogEvent& event) {
    if (event.channel != channel_names::calibration) return;
    calibration_.assign(event.data.begin(), event.data.end());
  }

  void write(const LogEvent& event) {
    if (!writer_) {
      first_us_ = event.time_us;
      open(event);
    } else if (parameters_.every && begins_piece(event)) {
      writer_->close();
      open(event);
    }
    writer_->write(event);
    ++events_;
    remember(event);
  }

  // Returns the names of the files.
  std::vector<path> close() {
    if (writer_) writer_->close();
    return std::move(files_);
  }

  std::uint64_t events() const { return events_; }
  // Returns whether a file begins with a calibration from before it.
  bool calibrated() const { return calibrated_; }

 private:
  // Whether the event belongs to the next piece.
  bool begins_piece(const LogEvent& event) {
    const PieceLimit& limit = *parameters_.every;
    if (!limit.is_time) {
      const auto bytes = header_bytes + event.channel.size() + event.data.size();
      return static_cast<double>(writer_->bytes() + bytes) > limit.most;
    }
    // Whole microseconds are used, because 0.3 s / 0.1 s is slightly less than 3 in doubles.
    const double since_us = std::round(seconds_between(first_us_, event.time_us) * 1e6);
    const double piece = std::floor(since_us / std::round(limit.most * 1e6));
    if (piece <= piece_) return false;
    piece_ = piece;
    return true;
  }

  void open(const LogEvent& first) {
    if (files_.size() == most_pieces) {
      throw std::runtime_error("more than " + std::to_string(most_pieces) +
                               " pieces: choose a larger --every");
    }
    files_.push_back(parameters_.every ? piece_name(parameters_.output, files_.size())
                                       : parameters_.output);
    refuse_same_file(log_, files_.back());
    writer_ = std::make_unique<LogWriter>(files_.back(), schema_);
    if (calibration_.empty() || first.channel == channel_names::calibration) return;
    LogEvent known = first;
    known.channel = channel_names::calibration;
    known.data = calibration_;
    writer_->write(known);
    calibrated_ = true;
  }

  const SplitParameters& parameters_;
  const path& log_;
  const schema::Schema& schema_;
  std::unique_ptr<LogWriter> writer_;
  std::vector<path> files_;
  std::vector<std::uint8_t> calibration_;  // the last message of it; empty: none
  bool calibrated_ = false;
  std::uint64_t events_ = 0;
  std::int64_t first_us_ = 0;
  double piece_ = 0.0;
};

}  // namespace

PieceLimit parse_piece_limit(const std::string& text) {
  constexpr std::pair<std::string_view, PieceLimit> units[] = {
      {"s", {1.0, true}},   {"min", {60.0, true}}, {"h", {3600.0, true}},
      {"kB", {1e3, false}}, {"MB", {1e6, false}},  {"GB", {1e9, false}}};
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  for (const auto& [name, unit] : units) {
    if (error != std::errc() || name != std::string_view(rest, end)) continue;
    const double most = value * unit.most;
    if (most >= (unit.is_time ? 1e-3 : 100.0) && most < 1e18) return {most, unit.is_time};
  }
  throw std::invalid_argument("'" + text +
                              "' is not the length of a piece: write a number and s, min, h, kB, "
                              "MB or GB, such as 60s or 100MB; at least 0.001s or 0.1kB");
}

LogSummary split(const path& log, const schema::Schema& schema, const SplitParameters& parameters,
                 std::ostream& out) {
  refuse_same_file(log, parameters.output);
  Pieces pieces(parameters, log, schema);
  std::optional<std::int64_t> first_us;
  const LogSummary read = read_log(log, schema, [&](const LogEvent& event) {
    if (!first_us) first_us = event.time_us;
    if (parameters.channels && !parameters.channels(event.channel)) return;
    const double since = seconds_between(*first_us, event.time_us);
    if (parameters.end_s && since >= *parameters.end_s) return;
    if (parameters.start_s && since < *parameters.start_s) {
      pieces.remember(event);
    } else {
      pieces.write(event);
    }
  });
  if (pieces.events() == 0) {
    throw std::runtime_error("none of the " + std::to_string(read.events) + " events of '" +
                             log.string() +
                             "' is within these times and channels: nothing written");
  }
  const std::vector<path> files = pieces.close();
  fmt::print(out, "{} of {} events written to {}", pieces.events(), read.events,
             files.front().string());
  if (files.size() > 1) {
    fmt::print(out, " and {} more, up to {}", files.size() - 1, files.back().string());
  }
  if (pieces.calibrated()) out << ", with the calibration that came before";
  out << '\n';
  return read;
}

}  // namespace maploop::lcm_log
