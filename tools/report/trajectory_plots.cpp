#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "msgs/frames.h"
#include "tools/match/road_lines.h"
#include "tools/report/sections.h"

namespace maploop::report {
namespace {

using web::Line;
using web::Plot;

constexpr double surroundings = 150.0;  // m, margin around the path in which roads are drawn

Geodetic origin_of(const ReplayReport& r) {
  if (!r.pass.track.states().empty()) return r.pass.track.states().front().origin;
  if (!r.reference.empty()) return r.reference.front().position;
  for (const auto& [stamp, state] : r.pass.ppp_states) {
    if (state.status != PppStatus::none) return state.position;
  }
  return {};
}

Time first_of(const ReplayReport& r) {
  if (!r.reference.empty()) return r.reference.front().stamp;
  if (!r.pass.track.states().empty()) return r.pass.track.states().front().stamp;
  return r.pass.ppp_states.empty() ? Time{} : r.pass.ppp_states.begin()->first;
}

void add(Line& line, double second, const Eigen::Vector3d& p) {
  line.add(p.x(), p.y());
  line.time.push_back(second);
}

// Ends a line where it has a gap.
void lift(Line& line, double second) {
  if (!line.x.empty() && std::isfinite(line.x.back()))
    add(line, second, Eigen::Vector3d::Constant(unknown));
}

// Leaves as much of a way as can be seen.
Line thinned(Line line) {
  const auto kept = web::thinned(line.x.size(), {&line.x, &line.y});
  for (auto* values : {&line.x, &line.y, &line.time}) *values = web::chosen(*values, kept);
  return line;
}

// Returns the rows of the reference that the replay, which may have ended early, reached.
std::vector<ReferencePose> replayed_reference(const Scene& scene) {
  std::vector<ReferencePose> rows;
  const std::vector<NavState>& states = scene.states();
  for (const ReferencePose& row : scene.report.reference) {
    if (states.empty() || row.stamp > states.back().stamp) break;
    rows.push_back(row);
  }
  return rows;
}

Line truth_line(const Scene& scene) {
  Line line{"truth", {}, {}};
  for (const ReferencePose& row : replayed_reference(scene)) {
    if (const auto pose = scene.truth->pose(row.stamp))
      add(line, scene.second(row.stamp), pose->translation());
  }
  return line;
}

Line fused_line(const Scene& scene) {
  Line line{"fused", {}, {}};
  Time last{};
  for (const NavState& s : scene.states()) {
    if (s.stamp - last > std::chrono::seconds(1)) lift(line, scene.second(last));
    add(line, scene.second(s.stamp), s.position_enu);
    last = s.stamp;
  }
  return line;
}

std::optional<Eigen::Isometry3d> fused_pose(const Scene& scene, Time stamp) {
  for (const NavState& s : scene.states()) {
    if (s.stamp < stamp) continue;
    return Eigen::Translation3d(s.position_enu) * Eigen::Isometry3d(rotation_enu_body(s.attitude));
  }
  return std::nullopt;
}

Line dead_reckoned_line(const Scene& scene, const std::string& name,
                        const tools::TrajectoryCollector& odometry) {
  Line line{name + " alone", {}, {}, Line::Look::dashed};
  const evaluation::StampedTrajectory trajectory = odometry.poses();
  std::optional<Eigen::Isometry3d> T_enu_first;
  for (std::size_t i = 0; i < trajectory.poses.size(); ++i) {
    const Eigen::Isometry3d& pose = trajectory.poses[i];
    if (!T_enu_first) {
      const Time stamp = trajectory.stamps[i];
      const auto begin = scene.truth ? scene.truth->pose(stamp) : fused_pose(scene, stamp);
      if (!begin) continue;
      T_enu_first = *begin * pose.inverse();
    }
    add(line, scene.second(trajectory.stamps[i]), (*T_enu_first * pose).translation());
  }
  return line;
}

// One quantity of the state: its name, value, standard deviation, and the truth's value.
struct Quantity {
  const char* name;
  const char* unit;
  std::function<double(const NavState&)> value, sigma;
  std::function<double(const Eigen::Isometry3d&)> truth;
  bool wraps = false;  // true for an angle in degrees
};

std::vector<Quantity> quantities() {
  const auto sigma = [](int i, double scale = 1.0) {
    return [i, scale](const NavState& s) { return scale * std::sqrt(s.covariance(i, i)); };
  };
  return {
      {"east", "m", [](const NavState& s) { return s.position_enu.x(); }, sigma(0),
       [](const Eigen::Isometry3d& T) { return T.translation().x(); }},
      {"north", "m", [](const NavState& s) { return s.position_enu.y(); }, sigma(1),
       [](const Eigen::Isometry3d& T) { return T.translation().y(); }},
      {"up", "m", [](const NavState& s) { return s.position_enu.z(); }, sigma(2),
       [](const Eigen::Isometry3d& T) { return T.translation().z(); }},
      {"azimuth", "deg", [](const NavState& s) { return degrees(s.attitude.azimuth); },
       sigma(6, degrees(1.0)),
       [](const Eigen::Isometry3d& T) {
         return degrees(attitude_from_rotation(T.rotation()).azimuth);
       },
       true},
  };
}

Line ppp_line(const Scene& scene) {
  Line line{"PPP", {}, {}};
  for (const auto& [stamp, state] : scene.report.pass.ppp_states) {
    if (state.status == PppStatus::none) {
      lift(line, scene.second(stamp));
    } else {
      add(line, scene.second(stamp), scene.frame.to_enu(state.position));
    }
  }
  return line;
}

Line matched_line(const Scene& scene) {
  Line line{"matched", {}, {}, Line::Look::points};
  for (const auto& [stamp, moment] : scene.report.pass.matches) {
    if (moment.on_road) add(line, scene.second(stamp), scene.frame.to_enu(moment.place));
  }
  return line;
}

ErrorSeries error_of(const Scene& scene, const Quantity& q) {
  ErrorSeries series{q.name, q.unit, "fused"};
  for (const NavState& s : scene.states()) {
    const auto pose = scene.truth ? scene.truth->pose(s.stamp) : std::nullopt;
    double off = pose ? q.value(s) - q.truth(*pose) : unknown;
    if (q.wraps) off = std::remainder(off, 360.0);
    series.seconds.push_back(scene.second(s.stamp));
    series.error.push_back(off);
    series.sigma.push_back(q.sigma(s));
  }
  return series;
}

Plot speed_plot(const Scene& scene) {
  constexpr double km_h = 3.6;
  Line fused{"fused", {}, {}}, truth{"truth", {}, {}};
  for (const NavState& s : scene.states()) {
    fused.add(scene.second(s.stamp), km_h * s.velocity_enu.head<2>().norm());
  }
  for (const ReferencePose& row : replayed_reference(scene)) {
    truth.add(scene.second(row.stamp), km_h * row.velocity_enu.head<2>().norm());
  }
  Plot plot{"Speed", "s", "km/h"};
  plot.over_time = true;
  for (const Line& line : {truth, fused}) {
    const auto kept = web::thinned(line.x.size(), {&line.y});
    if (!kept.empty())
      plot.lines.push_back({line.name, web::chosen(line.x, kept), web::chosen(line.y, kept)});
  }
  return plot;
}

}  // namespace

Scene::Scene(const ReplayReport& of) : report(of), frame(origin_of(of)), first(first_of(of)) {
  if (of.reference.size() > 1) truth.emplace(of.reference, frame);
}

web::Plot error_plot(const ErrorSeries& all) {
  const bool known =
      std::any_of(all.error.begin(), all.error.end(), [](double e) { return std::isfinite(e); });
  const auto kept = web::thinned(all.error.size(), {&all.error, &all.sigma});
  const ErrorSeries s{all.quantity,
                      all.unit,
                      all.of,
                      web::chosen(all.seconds, kept),
                      web::chosen(all.error, kept),
                      web::chosen(all.sigma, kept)};
  web::Plot plot{(known ? "Error " : "Uncertainty ") + s.quantity, "s", s.unit};
  plot.over_time = true;
  web::Band band{"3 sigma", s.seconds, {}, {}};
  for (const double sigma : s.sigma) {
    band.low.push_back(-sigmas * sigma);
    band.high.push_back(sigmas * sigma);
  }
  plot.bands.push_back(std::move(band));
  if (known) plot.lines.push_back({s.of + " minus truth", s.seconds, s.error});
  return plot;
}

web::Plot trajectory_map(const Scene& scene) {
  const ReplayReport& r = scene.report;
  Plot plot{"Way of the vehicle", "east, m", "north, m", {}, true};
  if (scene.truth) plot.lines.push_back(truth_line(scene));
  plot.lines.push_back(fused_line(scene));
  for (Line& line : std::vector{
           ppp_line(scene), dead_reckoned_line(scene, "stereo odometry", r.pass.odometry),
           dead_reckoned_line(scene, "LiDAR odometry", r.pass.lidar), matched_line(scene)}) {
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  for (Line& line : plot.lines) line = thinned(std::move(line));
  if (r.roads != nullptr)
    plot.roads = match::road_lines(*r.roads, scene.frame.origin(), plot.lines, surroundings);
  return plot;
}

std::vector<web::Plot> state_plots(const Scene& scene) {
  std::vector<Plot> plots;
  if (scene.states().empty()) return plots;
  for (const Quantity& q : quantities()) plots.push_back(error_plot(error_of(scene, q)));
  plots.push_back(speed_plot(scene));
  return plots;
}

}  // namespace maploop::report
