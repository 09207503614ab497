// Holds what the stages do against what the graph's table says of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "msgs/time.h"
#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {

// One stage as it looks now.
struct StageFacts {
  bool absent = false;         // this vehicle, or this recording, has no such sensor
  std::uint64_t count = 0;     // results since the start
  std::size_t waiting = 0;     // samples in the rings that end here
  std::string waits_for = {};  // of these rings, the empty one that holds the stage up
  // Of a driver, when its newest sample became available: maybe ahead of what the stages have come
  // to, which is no silence. Nothing: known by the count alone.
  std::optional<Time> newest = {};
};

// Of one stage. Stages without rates in the table are never found wanting. Looks at facts alone, on
// two clocks: a sensor's silence is a matter of data time, a stage that does not move stops data
// time too (a replay waits for it), so that takes the machine's. One thread at a time.
class Watchdog {
 public:
  // `start`: of the data. A stage reads nothing (a driver) or is fed by rings.
  enum class Kind : std::uint8_t { driver, fed };
  Watchdog(const Stage& stage, Kind kind, Time start, MonotonicTime wall_start);

  // What is wrong, one sentence each: what, since when, what to look at. Call with times that do
  // not decrease; the rate is judged once there is enough data for it, until the next judgement.
  std::vector<std::string> look(Time now, MonotonicTime wall_now, const StageFacts& facts);

  // How long a stage may be silent: three times the longest period that its table allows, and not
  // less than the health thread's own.
  static Duration patience(const Stage& stage);

 private:
  std::string stillness(Time now, MonotonicTime wall_now, const StageFacts& facts) const;
  void judge_rate(Time now, std::uint64_t count);

  Stage stage_;
  Kind kind_;
  std::uint64_t count_ = 0;
  Time moved_;  // when count_ was last seen to grow
  MonotonicTime wall_moved_;
  Time judged_;  // the rate since then is judged next
  std::uint64_t count_judged_ = 0;
  std::string rate_verdict_;
};

}  // namespace maploop::vehicle
