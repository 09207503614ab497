// The runs on an LCM bus: each says that it is there, so that listeners can tell them apart, and
// that two learn of each other.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "msgs/time.h"

namespace lcm {
class LCM;
class Subscription;
struct ReceiveBuffer;
}  // namespace lcm
namespace maploop_lcm {
class run_t;
}

namespace maploop::vehicle {

// A program that publishes.
struct Run {
  std::string id;    // of this run alone: eight hexadecimal digits
  std::string what;  // "replay of 2011_09_26_drive_0013_sync"
  bool operator==(const Run&) const = default;
};

// With a new id, drawn by the system: nothing that is computed knows it.
Run new_run(std::string what);

// "7f3a21bc (replay of 2011_09_26_drive_0013_sync)", without what a terminal would obey.
std::string to_text(const Run& run);

// What has been said on RUN. One thread's own.
class RunsHeard {
 public:
  // At `now`, of any steady clock. What is no run's id is left out, as are more than a few runs.
  void take(const maploop_lcm::run_t& message, Duration now);

  // In the order of their ids: those that have not said their end, nor been silent for 3 s.
  std::vector<Run> present(Duration now) const;

 private:
  struct Heard {
    std::string what;
    Duration at{};
  };
  std::map<std::string, Heard> runs_;
};

// Says a run on its bus, as long as it lives, and looks for others. One thread's own; `lcm` must
// outlive it.
class RunPresence {
 public:
  // `warn` gets one sentence, once, where another run publishes on the same bus.
  RunPresence(lcm::LCM& lcm, Run run, std::function<void(const std::string&)> warn);
  ~RunPresence();
  RunPresence(const RunPresence&) = delete;
  RunPresence& operator=(const RunPresence&) = delete;

  // Takes what has come, and says the run once a second. Never waits.
  void update();

  // What it says of the run at its end: three lines.
  void conclude(std::string verdict) { verdict_ = std::move(verdict); }

  const Run& run() const { return run_; }

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void say(bool ended);

  lcm::LCM& lcm_;
  Run run_;
  std::string verdict_;
  std::function<void(const std::string&)> warn_;
  lcm::Subscription* subscription_;  // of lcm_
  RunsHeard others_;
  bool warned_ = false;
  MonotonicTime next_{};
};

}  // namespace maploop::vehicle
