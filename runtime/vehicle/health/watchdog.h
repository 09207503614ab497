// Compares what the stages do with what the graph's table demands of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "msgs/time.h"
#include "runtime/vehicle/graph/stage_specs.h"

namespace maploop::vehicle {

// StageFacts is the state of one stage now.
struct StageFacts {
  std::uint64_t count = 0;     // results since the start
  std::size_t waiting = 0;     // samples in the rings that end here
  std::string waits_for = {};  // the empty one of these rings that holds the stage up
  // For a driver this is when its newest sample became available; it may be ahead of the stages,
  // which is not a silence. If it is nullopt, only the count shows whether the stage moves.
  std::optional<Time> newest = {};
};

// A Watchdog judges one stage by its facts; a stage without rates in the table is never reported.
// It uses two clocks. A sensor's silence is measured in data time. A stage that does not move stops
// data time too (a replay waits for it), so this is measured on the machine's clock. One thread at
// a time may use it.
class Watchdog {
 public:
  // A stage reads nothing (a driver), or is fed by rings. `start` is when the data begin.
  enum class Kind : std::uint8_t { driver, fed };
  Watchdog(const StageSpec& stage, Kind kind, Time start, MonotonicTime wall_start);

  // Returns what is wrong, one sentence each: what, since when, what to look at. Times must not
  // decrease from call to call. The rate is judged again after each patience() of data time.
  std::vector<std::string> look(Time now, MonotonicTime wall_now, const StageFacts& facts);

  // Returns how long a stage may be silent: three times the longest period that its table allows,
  // and at least the health thread's period.
  static Duration patience(const StageSpec& stage);

 private:
  std::string stillness(Time now, MonotonicTime wall_now, const StageFacts& facts) const;
  void judge_rate(Time now, std::uint64_t count);

  StageSpec stage_;
  Kind kind_;
  std::uint64_t count_ = 0;
  Time moved_;  // when count_ was last seen to grow
  MonotonicTime wall_moved_;
  Time judged_;  // the rate since then is judged next
  std::uint64_t count_judged_ = 0;
  std::string rate_verdict_;
};

}  // namespace maploop::vehicle
