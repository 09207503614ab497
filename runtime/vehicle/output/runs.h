// Announces each run on an LCM bus, so that listeners can tell the runs apart, and that two runs
// notice each other.
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

// A Run is a program that publishes on the bus.
struct Run {
  std::string id;    // of this run alone: eight hexadecimal digits
  std::string what;  // "replay of 2011_09_26_drive_0013_sync"
  bool operator==(const Run&) const = default;
};

// Returns a run with a random id from the system. No result depends on the id.
Run new_run(std::string what);

// Returns "7f3a21bc (replay of 2011_09_26_drive_0013_sync)"; control characters, which a terminal
// would obey, become question marks.
std::string to_text(const Run& run);

// RunsHeard contains the runs announced on RUN. It is for one thread.
class RunsHeard {
 public:
  // Takes a message that arrived at `now`, the time of any steady clock. Ignores a message whose id
  // is not that of a run, and a new run if there are 16 already.
  void take(const maploop_lcm::run_t& message, Duration now);

  // Returns the runs that have neither announced their end nor been silent for more than 3 s, in
  // the order of their ids.
  std::vector<Run> present(Duration now) const;

 private:
  struct Heard {
    std::string what;
    Duration at{};
  };
  std::map<std::string, Heard> runs_;
};

// Announces a run on its bus while this object exists, and looks for other runs. It is for one
// thread; `lcm` must outlive it.
class RunPresence {
 public:
  // `warn` is called once, with one sentence, when another run publishes on the same bus.
  RunPresence(lcm::LCM& lcm, Run run, std::function<void(const std::string&)> warn);
  ~RunPresence();
  RunPresence(const RunPresence&) = delete;
  RunPresence& operator=(const RunPresence&) = delete;

  // Takes the messages that have arrived, and announces the run once a second. Never blocks.
  void update();

  // Sets the verdict, three lines, which is sent with the end of the run.
  void conclude(std::string verdict) { verdict_ = std::move(verdict); }

  const Run& run() const { return run_; }

 private:
  void take(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void say(bool ended);

  lcm::LCM& lcm_;
  Run run_;
  std::string verdict_;
  std::function<void(const std::string&)> warn_;
  lcm::Subscription* subscription_;  // owned by lcm_
  RunsHeard others_;
  bool warned_ = false;
  MonotonicTime next_{};
};

}  // namespace maploop::vehicle
