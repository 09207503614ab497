// Finds fixes that no vehicle can have driven to: a receiver's (0, 0), or a jump of hundreds of
// metres.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "msgs/time.h"

namespace maploop::mapmatch {

// Judges fixes in the order of their stamps. A single fix out of reach is stray. Where the next one
// is within reach of it, the vehicle is there: what was before was wrong.
class ReachGate {
 public:
  enum class Found { near, stray, moved };

  // `place` is in local metres, and `sigma` (m) is its standard deviation on each axis.
  Found judge(Time stamp, const Eigen::Vector2d& place, double sigma) {
    const Seen now{stamp, place, sigma};
    const bool near = !last_ || reached(*last_, now);
    if (!near && !(stray_ && reached(*stray_, now))) {
      stray_ = now;
      return Found::stray;
    }
    last_ = now;
    stray_.reset();
    return near ? Found::near : Found::moved;
  }

  // The next fix may be anywhere.
  void reset() { *this = ReachGate(); }

  void archive(auto& ar) { ar(last_, stray_); }

 private:
  struct Seen {
    Time stamp{};
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    double sigma = 0.0;  // m
    void archive(auto& ar) { ar(stamp, place, sigma); }
  };
  // Whether a vehicle can have driven there. A filter that was long without fixes may step by a
  // hundred metres at its next one.
  static bool reached(const Seen& from, const Seen& to) {
    constexpr double top_speed = 100.0;     // m/s
    constexpr double largest_step = 100.0;  // m
    constexpr double sigmas = 5.0;
    return (to.place - from.place).norm() <=
           largest_step + top_speed * to_seconds(to.stamp - from.stamp) + sigmas * to.sigma;
  }

  std::optional<Seen> last_, stray_;
};

}  // namespace maploop::mapmatch
