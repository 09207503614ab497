#include "ppp/filter/map_aided_filter.h"

#include <Eigen/Dense>
#include <algorithm>

#include "ppp/models/geodesy.h"

namespace maploop::ppp {

const PppSolution& MapAidedFilter::process(const Epoch& epoch) {
  map_free_.process(epoch);
  time_ = epoch.time;
  if (aiding_) {
    aided_.process(epoch);
    check_separation();
  }
  return solution();
}

MapUse MapAidedFilter::add(const MapFeedback& feedback) {
  const MapUse use = this->use(feedback);
  ++uses_[static_cast<std::size_t>(use)];
  return use;
}

MapUse MapAidedFilter::use(const MapFeedback& feedback) {
  if (feedback.reason == FeedbackReason::inconsistent && aiding_) handle_contradiction();
  if (!feedback.position && !feedback.azimuth) return MapUse::nothing_fed_back;
  if (paused()) return MapUse::paused;
  if (map_free_.solution().status == PppStatus::none) return MapUse::no_position;
  MapFeedback helpful = feedback;
  const double share = parameters_.map_useful_share;
  helpful.position &= variance_across(feedback, map_free_.level_covariance()) >
                      share * share * map_variance(feedback);
  if (!helpful.position && !helpful.azimuth) return MapUse::no_help;
  if (!aiding_) {
    aided_ = map_free_;
    const MapUse use = aided_.add(helpful);
    aiding_ = use == MapUse::used;
    aiding_since_ = time_;
    return use;
  }
  const MapUse use = aided_.add(helpful);
  if (use == MapUse::used) gated_in_a_row_ = 0;
  if (use == MapUse::gated && ++gated_in_a_row_ >= parameters_.map_most_gated)
    handle_contradiction();
  return use;
}

bool MapAidedFilter::both_have_positions() const {
  return aided_.solution().status != PppStatus::none &&
         map_free_.solution().status != PppStatus::none;
}

Eigen::Vector2d MapAidedFilter::separation() const {
  const PppSolution &a = aided_.solution(), &f = map_free_.solution();
  return rotation_enu_ecef(geodetic_from_ecef(f.position)).topRows<2>() * (a.position - f.position);
}

// Returns the squared distance in standard deviations of the filter without the map. The standard
// deviation of the difference itself is smaller (Hausman, "Specification tests in econometrics",
// Econometrica 46, 1978), but almost zero in directions about which the map has contributed little.
double MapAidedFilter::distance() const {
  const Eigen::Vector2d off = separation();
  return off.dot(map_free_.level_covariance().inverse() * off);
}

// Lines contradict the filter, and it is unknown which side is wrong. What was learnt from the map
// stays if the filter without the map agrees with it; otherwise it is discarded.
void MapAidedFilter::handle_contradiction() {
  constexpr double within_sigma = 2.3;  // chi-square, 2 degrees of freedom, 68 %
  if (both_have_positions() && distance() > within_sigma) {
    restore();
  } else {
    pause();
  }
}

void MapAidedFilter::pause() {
  constexpr int max_doublings = 4;
  gated_in_a_row_ = 0;
  paused_until_ =
      time_ + from_seconds(parameters_.map_pause * (1 << std::min(pauses_, max_doublings)));
  ++pauses_;
}

void MapAidedFilter::check_separation() {
  const PppSolution &a = aided_.solution(), &f = map_free_.solution();
  // Either filter restarts if measurements contradict it for long; the one without the map is then
  // right.
  if (a.restarts != f.restarts) {
    restore();
    return;
  }
  constexpr Duration trusted_again = from_seconds(300.0);
  if (time_ - std::max(aiding_since_, paused_until_) > trusted_again) pauses_ = 0;
  if (!both_have_positions()) return;
  if (distance() <= parameters_.map_difference_gate) {
    separated_since_.reset();
    return;
  }
  if (!separated_since_) separated_since_ = time_;
  if (time_ - *separated_since_ >= from_seconds(parameters_.map_patience)) restore();
}

void MapAidedFilter::restore() {
  aiding_ = false;
  separated_since_.reset();
  pause();
  ++restorations_;
}

}  // namespace maploop::ppp
