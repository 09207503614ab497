// Makes a stage slow, or ends it, to show what a replay does with a consumer that cannot keep up or
// has ended.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "runtime/vehicle/faults/fault.h"

namespace maploop::vehicle {

// One stage's own; without any delay added it costs one comparison. A delay changes when results
// are available to others, never their content.
class StageDelay {
 public:
  // `struck` counts the items that were delayed, and must outlive the stage.
  void add(FaultWindow window, Duration by, std::atomic<std::uint64_t>& struck) {
    delays_.push_back({window, by, &struck});
  }

  // The stage ends with an error at its first item in the window.
  void add_end(FaultWindow window, std::atomic<std::uint64_t>& struck) {
    add(window, ends, struck);
  }

  // Sleeps as long as the item of data time t is to be delayed; throws if the stage is to end.
  void operator()(Time t) const {
    for (const Delay& delay : delays_) {
      if (!delay.window.contains(t)) continue;
      delay.struck->fetch_add(1, std::memory_order_relaxed);
      if (delay.by == ends) throw std::runtime_error("ended by an injected fault");
      std::this_thread::sleep_for(delay.by);
    }
  }

 private:
  static constexpr Duration ends = Duration::max();

  struct Delay {
    FaultWindow window;
    Duration by;
    std::atomic<std::uint64_t>* struck;
  };
  std::vector<Delay> delays_;
};

// By the name of the stage.
using StageDelays = std::map<std::string, StageDelay, std::less<>>;

}  // namespace maploop::vehicle
