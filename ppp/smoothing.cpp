#include "ppp/smoothing.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace maploop::ppp {

std::vector<Epoch> reversed(const std::vector<Epoch>& epochs) {
  std::vector<Epoch> backward(epochs.rbegin(), epochs.rend());
  std::map<std::tuple<Satellite, char, char>, bool> lost;  // between an epoch and the one before it
  bool no_power = false;
  for (Epoch& epoch : backward) {
    no_power = std::exchange(epoch.power_failure, no_power);
    for (const SatelliteSignals& s : epoch.satellites) {
      for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
        Signal& signal = epoch.signals[i];
        if (signal.phase == 0.0) continue;
        bool& was_lost = lost[{s.satellite, signal.band, signal.attribute}];
        was_lost = std::exchange(signal.lost_lock, was_lost);
      }
    }
  }
  return backward;
}

PppSolution combined(const PppSolution& forward, const PppSolution& backward) {
  if (!backward.has_position()) return forward;
  if (!forward.has_position()) return backward;
  const double forward_trace = forward.covariance.trace();
  const double backward_trace = backward.covariance.trace();
  const bool from_forward =
      forward.bridged == backward.bridged ? forward_trace <= backward_trace : backward.bridged;
  PppSolution both = from_forward ? forward : backward;
  both.status = std::max(forward.status, backward.status);
  both.bridged = forward.bridged && backward.bridged;
  // (29) of METHOD.md
  const double share = backward_trace / (forward_trace + backward_trace);
  const auto intersect = [share](const auto& x, const auto& P, const auto& y, const auto& Q) {
    const Eigen::Matrix3d weight = share * P.inverse(), other = (1.0 - share) * Q.inverse();
    const Eigen::Matrix3d covariance = (weight + other).inverse();
    return std::pair(Eigen::Vector3d(covariance * (weight * x + other * y)), covariance);
  };
  std::tie(both.position, both.covariance) =
      intersect(forward.position, forward.covariance, backward.position, backward.covariance);
  const bool moves = forward.velocity_covariance.trace() > 0.0;
  if (!moves) return both;
  std::tie(both.velocity, both.velocity_covariance) =
      intersect(forward.velocity, forward.velocity_covariance, backward.velocity,
                backward.velocity_covariance);
  return both;
}

}  // namespace maploop::ppp
