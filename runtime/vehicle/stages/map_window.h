// A map window holds the roads near the vehicle, and moves with it over a tiled map.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "msgs/archive.h"
#include "msgs/local_frame.h"
#include "runtime/core/thread.h"
#include "runtime/vehicle/stages/road_map.h"

namespace maploop::vehicle {

// The window has the size that the map tells. When the vehicle is so far from its middle, a thread
// without priority begins to read the roads about the vehicle, which later replace those before. So
// only the positions decide what happens when, and never how long the reading takes; follow() waits
// for it if it must. If they cannot be read there are no roads, and the next try is 500 m on. A
// window of a map that is not tiled never changes.
//
// Not thread-safe, but for failures(). Allocates when it begins to read.
class MapWindow {
 public:
  explicit MapWindow(std::shared_ptr<const RoadMap> map);

  // Returns the roads near the vehicle; none before its position is known.
  const std::shared_ptr<const mapmatch::RoadNetwork>& network() const { return network_; }
  // Takes the vehicle's place. Returns whether network() is another one now.
  bool follow(const Geodetic& place);
  bool moves() const { return map_->tiles != nullptr; }

  // Tells how often roads could not be read, and why the last time.
  struct Failures {
    std::uint64_t count = 0;
    std::string last;
  };
  Failures failures() const;

  // Archives which window it is. Loading reads its roads again.
  template <class Archive>
  void archive(Archive& ar) {
    Geodetic middle = middle_.value_or(Geodetic{});
    bool known = middle_.has_value();
    bool begun = reading_ != nullptr;
    Geodetic next = begun ? reading_->middle : Geodetic{};
    std::uint64_t failures = this->failures().count;
    ar(known, middle, begun, next, failures);
    if constexpr (Archive::loading) restore(known, middle, begun, next, failures);
  }

 private:
  // These are roads that are being read.
  struct Reading {
    Geodetic middle;
    std::shared_ptr<const mapmatch::RoadNetwork> network;
    std::string error;                      // why there is none
    std::optional<runtime::Thread> thread;  // it ends before the rest
  };

  std::unique_ptr<Reading> begin(const Geodetic& middle) const;
  void go_over(std::unique_ptr<Reading> reading);
  void restore(bool known, const Geodetic& middle, bool begun, const Geodetic& next,
               std::uint64_t failures);

  std::shared_ptr<const RoadMap> map_;
  std::shared_ptr<const mapmatch::RoadNetwork> network_;
  std::optional<Geodetic> middle_;
  std::unique_ptr<Reading> reading_;  // of the next window
  bool failed_ = false;               // there are no roads in this window
  mutable std::mutex mutex_;          // protects what follows
  Failures failures_;
};

}  // namespace maploop::vehicle
