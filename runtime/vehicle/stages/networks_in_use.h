// Which road network the matches of a time refer to, for those who read them later.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>

#include "mapmatch/road_network.h"
#include "msgs/time.h"

namespace maploop::vehicle {

// Any thread may use it. The lock is taken by the matching only when its network changes.
class NetworksInUse {
 public:
  // The matches of states after `stamp` refer to this network.
  void begin(Time stamp, std::shared_ptr<const mapmatch::RoadNetwork> network) {
    Use before{stamp, std::move(network)};  // is destroyed without the lock
    const std::scoped_lock lock(mutex_);
    std::swap(last_[next_++ % last_.size()], before);
  }

  // Returns the network to which the match of a state refers; nullptr if two have followed it.
  std::shared_ptr<const mapmatch::RoadNetwork> at(Time stamp) const {
    const std::scoped_lock lock(mutex_);
    for (std::size_t back = 1; back <= std::min(next_, last_.size()); ++back) {
      const Use& use = last_[(next_ - back) % last_.size()];
      if (stamp > use.after) return use.network;
    }
    return nullptr;
  }

 private:
  struct Use {
    Time after{};
    std::shared_ptr<const mapmatch::RoadNetwork> network;
  };

  mutable std::mutex mutex_;
  std::array<Use, 2> last_{};
  std::size_t next_ = 0;
};

}  // namespace maploop::vehicle
