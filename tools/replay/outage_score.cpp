#include "tools/replay/outage_score.h"

#include <algorithm>
#include <cmath>

#include "sensors/replay/reference_trajectory.h"

namespace maploop::fusion_score {
namespace {

using Eigen::Vector2d;

struct Moment {
  Vector2d position;  // m, enu
  double variance;    // m^2, trace
};

// Interpolates between two states of the track.
std::optional<Moment> moment(const std::vector<NavState>& states, Time t) {
  constexpr Duration apart = std::chrono::milliseconds(500);
  const auto after =
      std::lower_bound(states.begin(), states.end(), t,
                       [](const NavState& s, Time stamp) { return s.stamp < stamp; });
  if (after == states.begin() || after == states.end()) return std::nullopt;
  const NavState &a = *std::prev(after), &b = *after;
  if (b.stamp - a.stamp > apart) return std::nullopt;
  const double share = to_seconds(t - a.stamp) / to_seconds(b.stamp - a.stamp);
  const Eigen::Vector3d p = a.position_enu + share * (b.position_enu - a.position_enu);
  return Moment{p.head<2>(), b.covariance.topLeftCorner<2, 2>().trace()};
}

}  // namespace

std::vector<OutageEnd> outage_ends(const NavTrack& track, const std::vector<GnssFix>& fixes,
                                   const std::vector<ReferencePose>& reference,
                                   const std::vector<vehicle::GnssOutage>& outages, Time origin) {
  std::vector<OutageEnd> ends;
  if (track.states().empty() || fixes.empty()) return ends;
  const LocalFrame frame(track.states().front().origin);
  std::optional<sensors::ReferenceTrajectory> peer;
  if (reference.size() >= 2) peer.emplace(reference, frame);
  const auto place = [&](const GnssFix& fix) {
    return Vector2d(frame.to_enu(fix.position).head<2>());
  };
  for (const vehicle::GnssOutage& o : outages) {
    const auto before = [](const GnssFix& fix, Time t) { return fix.stamp < t; };
    const auto first = std::lower_bound(fixes.begin(), fixes.end(), o.begin, before);
    const auto end = std::lower_bound(first, fixes.end(), o.end, before);
    if (first == end || track.states().front().stamp > o.begin) continue;
    const GnssFix& last = *std::prev(end);
    const auto state = moment(track.states(), last.stamp);
    if (!state) continue;
    OutageEnd result{
        to_seconds(o.begin - origin), to_seconds(last.stamp - o.begin), 0.0, 0.0, 0.0, {}};
    for (auto fix = first == fixes.begin() ? first + 1 : first; fix != end; ++fix) {
      result.distance += (place(*fix) - place(*std::prev(fix))).norm();
    }
    result.error = (state->position - place(last)).norm();
    result.sigma =
        std::sqrt(state->variance + last.position_covariance.topLeftCorner<2, 2>().trace());
    if (peer) {
      if (const auto pose = peer->pose(last.stamp))
        result.peer = (pose->translation().head<2>() - place(last)).norm();
    }
    ends.push_back(result);
  }
  return ends;
}

}  // namespace maploop::fusion_score
