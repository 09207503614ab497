// Corrects the filter by the road that map matching has found.
#pragma once

#include <cstdint>
#include <string_view>

#include "msgs/map_feedback.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"
#include "ppp/filter/parameters.h"

namespace maploop::ppp {

// A MapUse tells what happened to a feedback.
enum class MapUse : std::uint8_t {
  used,
  nothing_fed_back,   // it contains neither a line nor a direction
  not_usable,         // it is not finite, or a standard deviation or the probability is invalid
  no_position,        // the filter had none at the last epoch
  not_of_this_epoch,  // its stamp is too far from the last epoch
  no_help,            // the filter knows its place across the road better than the map
  gated,              // it is too far from the filter's state
  paused,             // the map is paused after a wrong road
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

// The row is 0 = n (p - d + v since - m) - lane_sigma b + noise: n points to the right of the
// line through m, p is the position, d the map's datum, b the lane offset, and `since` is the
// feedback's stamp minus the state's, s. Only the direction across the line is used: along it, a
// projection contains nothing that the filter did not know before.
LinearRow line_row(const FilterState& state, const MapFeedback& feedback, double since);
// The row is 0 = n v + noise: the vehicle moves along the line. `slip` is in m/s.
LinearRow direction_row(const FilterState& state, const MapFeedback& feedback, double slip);

// Resets the states that only a map observes.
void begin_map_states(FilterState& state, const PppParameters& parameters);
// Lets the lane offset decay with the distance driven. `interval` is in s.
void predict_map_states(FilterState& state, double interval, const PppParameters& parameters);
// Changes to another road: its lane offset is new except for the share that lasts.
void enter_road(FilterState& state, const PppParameters& parameters);

// Returns the variance of the map's position across the line, m^2: of lane and map, and of what is
// new at each feedback.
double map_variance(const MapFeedback& feedback);
// Returns the variance across the line, m^2; `covariance` is east and north.
double variance_across(const MapFeedback& feedback, const Eigen::Matrix2d& covariance);

// Applies direction and line, each behind a gate; the direction only if it improves on the state.
// The result is that of the line if there is one. A link of probability P gets noise that makes its
// information P times that of a certain link. `covariance` is the position's, east and north, m^2;
// `dx` is working memory of the state's size.
MapUse apply_map(FilterState& state, const MapFeedback& feedback, double since,
                 const Eigen::Matrix2d& covariance, const PppParameters& parameters,
                 Eigen::VectorXd& dx);

}  // namespace maploop::ppp
