// Correction by the road that the map matching has found.
#pragma once

#include <cstdint>
#include <string_view>

#include "msgs/map_feedback.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"
#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// What became of a feedback.
enum class MapUse : std::uint8_t {
  used,
  nothing_fed_back,   // there is nothing in it
  not_usable,         // a number that is none, or a deviation that is none
  no_position,        // of the filter at the last epoch
  not_of_this_epoch,  // its stamp is too far from the last epoch
  no_help,            // the filter knows its place across the road better than the map
  gated,              // too far from where the filter is
  paused,             // a while after a wrong road
};
constexpr std::size_t map_use_count = static_cast<std::size_t>(MapUse::paused) + 1;

constexpr std::string_view to_string(MapUse use) {
  switch (use) {
    case MapUse::used:
      return "used";
    case MapUse::nothing_fed_back:
      return "nothing fed back";
    case MapUse::not_usable:
      return "not usable";
    case MapUse::no_position:
      return "no position";
    case MapUse::not_of_this_epoch:
      return "not of this epoch";
    case MapUse::no_help:
      return "known better than by the map";
    case MapUse::gated:
      return "line too far away";
    case MapUse::paused:
      return "paused behind a wrong road";
  }
  return "unknown";
}

// 0 = n (p + e - d + v since - m) - lane_sigma b + noise, n to the right of the line through m; p
// what satellites say, e its lasting error, d the map's datum, b the lane offset; `since` s is the
// feedback's stamp less the state's. Across the line alone: along it, a
// projection says nothing that the filter did not say before.
LinearRow line_row(const FilterState& state, const MapFeedback& feedback, double since);
// 0 = n v + noise: the vehicle goes the line's way.
LinearRow direction_row(const FilterState& state, const MapFeedback& feedback, double slip);

// Nothing is known of what only a map observes. `lasting` m^2, east and north: of the position, by
// errors of orbits, clocks and ionosphere.
void begin_map_states(FilterState& state, const Eigen::Vector2d& lasting,
                      const PppParameters& parameters);
// The lane offset changes with the way, the lasting error with time.
void predict_map_states(FilterState& state, double interval, const Eigen::Vector2d& lasting,
                        const PppParameters& parameters);
// Another road: another offset but for the share that lasts.
void enter_road(FilterState& state, const PppParameters& parameters);

// Of the place across the line, m^2: by lane, map and what is new at each feedback.
double map_variance(const MapFeedback& feedback);
// By a covariance of east and north.
double variance_across(const MapFeedback& feedback, const Eigen::Matrix2d& covariance);

// Line and direction, each gated; the direction only where the state does not know it better
// already. The result is the line's where there is one. A link of probability P has noise that
// makes its information P times that of a certain one. `covariance` is the position's, east and
// north; `dx` is room for a state.
MapUse apply_map(FilterState& state, const MapFeedback& feedback, double since,
                 const Eigen::Matrix2d& covariance, const PppParameters& parameters,
                 Eigen::VectorXd& dx);

}  // namespace maploop::ppp
