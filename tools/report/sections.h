// The parts of the page, and what their pictures share.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "sensors/replay/reference_trajectory.h"
#include "tools/profile/profile.h"
#include "tools/report/report.h"
#include "tools/web/page.h"

namespace maploop::report {

inline constexpr double sigmas = 3.0;
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // a gap in a line

// Headings that events lead to.
inline constexpr const char* error_heading = "Absolute error";
inline constexpr const char* road_heading = "Link identification";
inline constexpr const char* ppp_heading = "Precise point positioning";
inline constexpr const char* loss_heading = "What was lost or not used";
inline constexpr const char* latency_heading = "Latencies and deadlines";

// The replay in the common frame of all pictures.
struct Scene {
  explicit Scene(const ReplayReport& of);

  const ReplayReport& report;
  // Its origin is that of the first state; if there is none, the first reference pose, or the first
  // position by PPP.
  LocalFrame frame;
  std::optional<sensors::ReferenceTrajectory> truth;  // if the recording has a reference
  Time first;                                         // plots count their seconds from here

  double second(Time t) const { return to_seconds(t - first); }
  const std::vector<NavState>& states() const { return report.pass.track.states(); }
};

// All lists have the same length; an error that is not finite is unknown at that time.
struct ErrorSeries {
  std::string quantity;  // such as east
  std::string unit;
  std::string of;  // source of the error: fused, PPP
  std::vector<double> seconds{}, error{}, sigma{};
};

// Plots an error against time with three of its estimated standard deviations. Without any known
// error it plots only the standard deviations.
web::Plot error_plot(const ErrorSeries& series);

// Returns what was out of the ordinary, in the order of time: outages, the largest error, faults,
// states that are not aided, jumps of the position, refused odometry, roads that were left, epochs
// without a position by PPP, and the worst missed deadlines.
std::vector<web::Event> events(const Scene& scene, const profile::Profile& times);

// Plots the view from above, in the fused state's own frame, over the roads of the replay's map:
// truth, fused, PPP, matched points, and dead reckoning placed at the truth's first pose (the fused
// one without a truth).
web::Plot trajectory_map(const Scene& scene);

// Plots against seconds of the drive: errors with three of the filter's standard deviations, and
// the speed. Without a truth only the standard deviations and the fused speed.
std::vector<web::Plot> state_plots(const Scene& scene);

// Adds how the errors of the fused position compare with their protection levels, if there is a
// reference for any.
void add_protection(web::Page& page, const Scene& scene);

// Adds the roads that the vehicle was matched to, if any, and how often they were right if the
// recording contains the links driven.
void add_roads(web::Page& page, const Scene& scene);

// Adds what the filter has estimated of the car and its sensors, and how, if it has started.
void add_calibration(web::Page& page, const Scene& scene);

// Adds the results of precise point positioning, if there were observations. Errors are those of
// the antenna against the truth.
void add_ppp(web::Page& page, const Scene& scene);

}  // namespace maploop::report
