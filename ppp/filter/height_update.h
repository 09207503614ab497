// Corrects the filter by the height of the ground that the vehicle is on.
#pragma once

#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"
#include "ppp/filter/parameters.h"
#include "ppp/heights/height_model.h"

namespace maploop::ppp {

// Makes the row of the ground's height at the state's position, (23) and (24) of METHOD.md;
// `ground` is the model's there.
LinearRow height_row(const FilterState& state, const Ground& ground,
                     const GroundParameters& parameters);

// Lets the model's error decay over the way of the interval, s, if it is in use.
void predict_height_states(FilterState& state, double interval, const GroundParameters& parameters);

// Applies the height, behind a gate. The first time it opens the states of the model's errors.
// `dx` is working memory of the state's size.
HeightUse apply_height(FilterState& state, const HeightModel& heights,
                       const GroundParameters& parameters, Eigen::VectorXd& dx);

}  // namespace maploop::ppp
