#include "estimators/fusion/map_update.h"

#include <cmath>

#include "estimators/fusion/measurement_check.h"

namespace maploop::fusion {
namespace {

// Sets a state to a known value that is uncorrelated with all other states.
void set_known(FilterState& state, int i, double value, double sigma) {
  state.x[i] = value;
  state.P.row(i).setZero();
  state.P.col(i).setZero();
  state.P(i, i) = sigma * sigma;
}

void reset(FilterState& state, const MapFeedback& feedback, const LocalFrame& frame) {
  using namespace index;
  const Eigen::Vector3d point = frame.to_enu(feedback.point);
  const OdomPose odom = state.odom_of_described();
  set_known(state, east, point.x(), feedback.cross_sigma);
  set_known(state, north, point.y(), feedback.cross_sigma);
  set_known(state, azimuth, feedback.link_azimuth, feedback.azimuth_sigma);
  start_clone(state, odom);
}

}  // namespace

Innovation<1> line_innovation(const FilterState& state, const MapFeedback& feedback,
                              const LocalFrame& frame) {
  using namespace index;
  const Eigen::Vector2d right = right_of_line(feedback);
  const Eigen::Vector2d off = state.x.segment<2>(east) - frame.to_enu(feedback.point).head<2>();
  // (21) of METHOD.md
  Innovation<1> innovation(feedback.lane_sigma * state.x[lane_offset] - right.dot(off),
                           feedback.cross_sigma * feedback.cross_sigma);
  innovation.H.segment<2>(east) = right;
  innovation.H[lane_offset] = -feedback.lane_sigma;
  return innovation;
}

Innovation<1> link_azimuth_innovation(const FilterState& state, const MapFeedback& feedback) {
  // (22) of METHOD.md
  Innovation<1> innovation(wrap_angle(feedback.link_azimuth - state.x[index::azimuth]),
                           feedback.azimuth_sigma * feedback.azimuth_sigma);
  innovation.H[index::azimuth] = 1.0;
  return innovation;
}

void enter_road(FilterState& state, const FusionParameters& p) {
  const int b = index::lane_offset;
  const double keep = p.lane_lasting;
  state.x[b] *= keep;
  state.P.row(b) *= keep;
  state.P.col(b) *= keep;
  state.P(b, b) += 1.0 - keep * keep;
}

Reason check_feedback(const MapFeedback& f, const FusionParameters& p) {
  if (!all_finite(f)) return Reason::not_finite;
  if (!f.position && !f.azimuth) return Reason::nothing_fed_back;
  if (!has_sigmas(f)) return Reason::invalid_covariance;
  return stamped_after_delivery(f, p) ? Reason::after_delivery : Reason::none;
}

Outcome apply_map(FilterState& state, const MapFeedback& feedback, const LocalFrame& frame,
                  const FusionParameters& p) {
  if (feedback.reset) {
    reset(state, feedback, frame);
    state.map_stamp = state.stamp;
    return {};
  }
  if (feedback.new_road) enter_road(state, p);
  Outcome azimuth;
  if (feedback.azimuth) {
    azimuth = apply_gated(state, link_azimuth_innovation(state, feedback), p.map_azimuth_gate,
                          Reason::link_azimuth_gate, p.max_tilt);
  }
  Outcome outcome = azimuth;
  if (feedback.position) {
    const auto correct = [&] {
      return apply_gated(state, line_innovation(state, feedback, frame), p.map_position_gate,
                         Reason::line_gate, p.max_tilt);
    };
    outcome = correct();
    // While the last GNSS fix is recent enough to be correlated with the present error, a
    // contradiction means that the road is wrong.
    const bool on_its_own = state.stamp - state.gnss_stamp > from_seconds(p.gnss_offset_time);
    if (outcome.refused() && ++state.map_gated_in_a_row == p.map_recover_after && on_its_own) {
      for (const int i : {index::east, index::north})
        doubt_with_clone(state, i, p.map_recovery_sigma);
      ++state.recoveries;
      outcome = correct();
    }
    if (!outcome.refused()) state.map_gated_in_a_row = 0;
  }
  if (!outcome.refused()) state.map_stamp = state.stamp;
  return outcome;
}

}  // namespace maploop::fusion
