#include "tools/log/log_split.h"

#include <fmt/format.h>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "msgs/lcm/log/log_reader.h"
#include "tools/log/log_text.h"
#include "tools/log/log_writer.h"
#include "tools/log/progress.h"

namespace maploop::lcm_log {
namespace {

constexpr std::size_t kMaximumPieces = 10'000;

struct Unit {
  std::string_view name;
  double factor;
  bool time;
};
constexpr std::array<Unit, 6> kUnits{{{"s", 1.0, true},
                                      {"min", 60.0, true},
                                      {"h", 3600.0, true},
                                      {"kB", 1e3, false},
                                      {"MB", 1e6, false},
                                      {"GB", 1e9, false}}};

// Returns for instance "out.012.lcmlog.gz" for "out.lcmlog.gz".
std::filesystem::path piece_name(const std::filesystem::path& output, std::size_t number) {
  std::string stem = output.stem().string();
  std::string extension = output.extension().string();
  if (extension == ".gz") {
    const std::filesystem::path inner(stem);
    stem = inner.stem().string();
    extension = inner.extension().string() + extension;
  }
  std::string name = fmt::format(".{:03}", number);
  return output.parent_path() / (stem + name + extension);
}

class Pieces {
 public:
  explicit Pieces(const SplitParameters& parameters, const std::filesystem::path& log)
      : parameters_(parameters), log_(log) {}

  void write(const LogEvent& event) {
    if (!first_us_) first_us_ = event.time_us;
    if (!writer_ || begins_piece(event)) open();
    writer_->write(event);
  }

  std::vector<std::filesystem::path> close() {
    if (writer_) writer_->close();
    return std::move(files_);
  }

 private:
  // Whether the event belongs to the next piece.
  bool begins_piece(const LogEvent& event) {
    if (!parameters_.every) return false;
    if (const auto& seconds = parameters_.every->seconds) {
      // Whole microseconds are used, because 0.3 s / 0.1 s is slightly less than 3 in doubles.
      const double since_us = std::round(seconds_between(*first_us_, event.time_us) * 1e6);
      const double piece = std::floor(since_us / std::round(*seconds * 1e6));
      if (piece <= piece_) return false;
      piece_ = piece;
      return true;
    }
    const std::uint64_t bytes = kHeaderBytes + event.channel.size() + event.data.size();
    return writer_->bytes() + bytes > *parameters_.every->bytes;
  }

  void open() {
    if (writer_) writer_->close();
    if (files_.size() == kMaximumPieces) {
      throw std::runtime_error("more than " + std::to_string(kMaximumPieces) +
                               " pieces: choose a larger --every");
    }
    files_.push_back(parameters_.every ? piece_name(parameters_.output, files_.size())
                                       : parameters_.output);
    refuse_same_file(log_, files_.back());
    writer_ = std::make_unique<LogWriter>(files_.back());
  }

  const SplitParameters& parameters_;
  const std::filesystem::path& log_;
  std::unique_ptr<LogWriter> writer_;
  std::vector<std::filesystem::path> files_;
  std::optional<std::int64_t> first_us_;
  double piece_ = 0.0;
};

}  // namespace

PieceLimit parse_piece_limit(const std::string& text) {
  double value = 0.0;
  const auto [unit, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view name(unit, static_cast<std::size_t>(text.data() + text.size() - unit));
  for (const Unit& u : kUnits) {
    if (error != std::errc() || u.name != name || !std::isfinite(value)) continue;
    value *= u.factor;
    if (u.time && value >= 1e-3) return {.seconds = value, .bytes = {}};
    if (!u.time && value >= 100.0 && value < 1e18) {
      return {.seconds = {}, .bytes = static_cast<std::uint64_t>(value)};
    }
  }
  throw std::invalid_argument("'" + text +
                              "' is no length of a piece: write a number and s, min, h, kB, MB or "
                              "GB, such as 60s or 100MB; at least 0.001s or 0.1kB");
}

SplitResult split(const std::filesystem::path& log, const schema::Schema& schema,
                  SplitParameters parameters) {
  refuse_same_file(log, parameters.output);
  LogReader reader(log, schema);
  Progress progress(reader.input().file_size());
  Pieces pieces(parameters, log);
  SplitResult result;
  std::int64_t first_us = 0;
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    progress.at(reader.input().file_position());
    if (item == LogReader::Item::damage) {
      ++result.damages;
      result.damaged_bytes += reader.damage().end - reader.damage().begin;
      continue;
    }
    const LogEvent& event = reader.event();
    if (result.events_read++ == 0) first_us = event.time_us;
    const double since = seconds_between(first_us, event.time_us);
    if (parameters.start_s && since < *parameters.start_s) continue;
    if (parameters.end_s && since >= *parameters.end_s) continue;
    if (!parameters.channels.takes(event.channel)) continue;
    pieces.write(event);
    ++result.events_taken;
  }
  result.files = pieces.close();
  if (result.events_taken == 0) {
    throw std::runtime_error("none of the " + std::to_string(result.events_read) + " events of '" +
                             log.string() +
                             "' is within these times and channels: nothing written");
  }
  return result;
}

}  // namespace maploop::lcm_log
