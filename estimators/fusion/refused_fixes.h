// Fixes that a gate has refused in a row: whether the vehicle's position is wrong, or the fixes
// are.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "msgs/time.h"

namespace maploop::fusion {

// Where the state is wrong, by whatever position and azimuth, the fixes lie as the vehicle's way by
// odometry or wheels does, moved and turned. A receiver that repeats an old fix, or whose fixes
// scatter by more than it says, fails this, and the row begins anew with its last fix.
struct RefusedFixes {
  int count = 0;  // of the row
  // Whether a fix of the row, or of one that it has replaced, did not follow the vehicle's motion.
  bool astray = false;
  Time first{};  // stamp of the row's first fix
  // At the first fix: its position, and the vehicle's in the frame of odometry; m, horizontal.
  Eigen::Vector2d position = Eigen::Vector2d::Zero(), vehicle = Eigen::Vector2d::Zero();
  double variance = 0.0;  // of that fix's position, m^2
  // Sums over the row's other fixes, of vectors from the first, each by its variance: of the
  // squared lengths, and of the scalar and vector products of the fixes' and the vehicle's.
  double squares = 0.0, dot = 0.0, cross = 0.0;

  // Adds a refused fix; `moving` is the newest stamp at which odometry or wheels were applied.
  void add(Time t, const Eigen::Vector2d& fix, double its_variance,
           const Eigen::Vector2d& vehicle_now, Time moving, double gate) {
    constexpr double way_share = 0.05;  // of the way, which odometry gets wrong at most
    constexpr double scatter = 8.0;     // of a fix: its mean of 2, for twice the sigma
    const Eigen::Vector2d seen = fix - position, way = vehicle_now - vehicle;
    const double v = variance + its_variance + way_share * way_share * way.squaredNorm();
    if (count > 0 && moving > first) {
      squares += (seen.squaredNorm() + way.squaredNorm()) / v;
      dot += seen.dot(way) / v;
      cross += (seen.x() * way.y() - seen.y() * way.x()) / v;
    }
    // (38) of METHOD.md
    const double misfit = squares - 2.0 * std::hypot(dot, cross);
    const bool contradicts = count > 0 && misfit > gate + scatter * (count - 1);
    astray = astray || contradicts;
    if (contradicts || count == 0) *this = {0, astray, t, fix, vehicle_now, its_variance};
    ++count;
  }
};

template <class Archive>
void archive(Archive& ar, RefusedFixes& r) {
  ar(r.count, r.astray, r.first, r.position, r.vehicle, r.variance, r.squares, r.dot, r.cross);
}

}  // namespace maploop::fusion
