// Recovers everything readable of a damaged log, and reports the losses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::lcm_log {

struct RecoverParameters {
  // An event whose time is outside those of its neighbours by more than this gets the time of its
  // predecessor; threads that log differ by less.
  double max_disorder_s = 1.0;
  std::size_t max_listed = 1000;  // entries kept in each list; all are counted
};

// Bytes left out. The numbers of the lost events are known if those of the neighbouring events are.
struct Loss {
  std::uint64_t begin = 0, end = 0;
  std::string reason;
  std::optional<std::int64_t> first_event = {}, last_event = {};
  std::optional<std::int64_t> after_us = {}, before_us = {};  // log time of the neighbouring events
};

struct TimeRepair {
  std::int64_t event = 0;  // number in the damaged log
  std::int64_t was_us = 0, is_us = 0;
};

struct Recovery {
  std::string file;
  std::uint64_t bytes = 0;   // size of the damaged log, uncompressed
  std::uint64_t events = 0;  // written
  std::vector<Loss> losses;
  std::uint64_t loss_count = 0, lost_bytes = 0;
  std::uint64_t lost_events = 0;  // as far as event numbers show
  std::vector<TimeRepair> repairs;
  std::uint64_t repair_count = 0;
};

// Bytes that are not an event (LogReader) and messages of known type that do not decode are lost.
// Events are numbered again from 0. Throws std::runtime_error if a file cannot be read or written
// or no event is found; std::invalid_argument if the output is the log itself.
Recovery recover(const std::filesystem::path& log, const schema::Schema& schema,
                 const std::filesystem::path& output, const RecoverParameters& parameters = {});

std::string format_report(const Recovery& recovery);

}  // namespace maploop::lcm_log
