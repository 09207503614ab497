#include "ppp/filter/map_aided_filter.h"

#include <Eigen/Dense>
#include <algorithm>

namespace maploop::ppp {

const PppSolution& MapAidedFilter::process(const Epoch& epoch, const CarriedMotion* carried) {
  map_free_.process(epoch, carried);
  time_ = epoch.time;
  if (aiding_) {
    aided_.process(epoch, carried);
    compare();
  }
  return solution();
}

void MapAidedFilter::count_anew() {
  map_free_.count_anew();
  aided_.count_anew();
  uses_ = {};
  restorations_ = 0;
}

MapUse MapAidedFilter::add(const MapFeedback& feedback) {
  if (feedback.reason == FeedbackReason::inconsistent && aiding_) handle_contradiction();
  const MapUse use = apply(feedback);
  if (use == MapUse::used) gated_in_a_row_ = 0;
  if (use == MapUse::gated && aiding_ && ++gated_in_a_row_ >= parameters_.map_most_gated)
    handle_contradiction();
  ++uses_[static_cast<std::size_t>(use)];
  return use;
}

MapUse MapAidedFilter::apply(const MapFeedback& feedback) {
  if (!feedback.position && !feedback.azimuth) return MapUse::nothing_fed_back;
  if (paused()) return MapUse::paused;
  if (map_free_.solution().status == PppStatus::none) return MapUse::no_position;
  MapFeedback helpful = feedback;
  const double share = parameters_.map_useful_share;
  helpful.position &= variance_across(feedback, map_free_.level_covariance()) >
                      share * share * map_variance(feedback);
  if (!helpful.position && !helpful.azimuth) return MapUse::no_help;
  if (aiding_) return aided_.add(helpful);
  aided_ = map_free_;
  const MapUse use = aided_.add(helpful);
  aiding_ = use == MapUse::used;
  aiding_since_ = time_;
  return use;
}

// Returns the squared distance in standard deviations of the filter without the map, or nothing if
// either filter has no position. The standard deviation of the difference itself is smaller
// (Hausman, "Specification tests in econometrics", Econometrica 46, 1978), but almost zero in
// directions about which the map has contributed little. A wrong road may show in the height first:
// it is what the ranges have most in common with.
std::optional<double> MapAidedFilter::distance() const {
  const PppSolution &a = aided_.solution(), &f = map_free_.solution();
  if (a.status == PppStatus::none || f.status == PppStatus::none) return {};
  const Eigen::Vector3d apart = a.position - f.position;
  return apart.dot(f.covariance.inverse() * apart);
}

// Lines contradict the filter, and it is unknown which side is wrong. What was learnt from the map
// stays if the filter without the map agrees with it; otherwise it is discarded.
void MapAidedFilter::handle_contradiction() {
  const auto far = distance();
  if (far && *far > parameters_.map_agreement_gate) {
    restore();
  } else {
    pause();
  }
}

void MapAidedFilter::pause() {
  gated_in_a_row_ = 0;
  paused_until_ = time_ + from_seconds(parameters_.map_pause *
                                       (1 << std::min(pauses_, parameters_.map_pause_doublings)));
  ++pauses_;
}

void MapAidedFilter::compare() {
  // Either filter restarts if measurements contradict it for long; the one without the map is then
  // right.
  if (aided_.solution().restarts != map_free_.solution().restarts) {
    restore();
    return;
  }
  if (time_ - std::max(aiding_since_, paused_until_) > from_seconds(parameters_.map_trusted_again))
    pauses_ = 0;
  const auto far = distance();
  if (!far) return;
  if (*far <= parameters_.map_difference_gate) {
    apart_since_.reset();
    return;
  }
  if (!apart_since_) apart_since_ = time_;
  if (time_ - *apart_since_ >= from_seconds(parameters_.map_patience)) restore();
}

void MapAidedFilter::restore() {
  aiding_ = false;
  apart_since_.reset();
  pause();
  ++restorations_;
}

}  // namespace maploop::ppp
