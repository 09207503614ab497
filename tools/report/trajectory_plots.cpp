#include "tools/report/trajectory_plots.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "msgs/frames.h"
#include "sensors/replay/reference_trajectory.h"
#include "tools/match/road_lines.h"

namespace maploop::report {
namespace {

using web::Line;
using web::Plot;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double sigmas = 3.0;
constexpr double surroundings = 150.0;  // m about the way, of which roads are drawn

using Truth = std::optional<sensors::ReferenceTrajectory>;

// Of the first state, or of the first reference pose where there is no state.
Geodetic origin_of(const ReplayReport& r) {
  return r.track.states().empty() ? r.reference.front().position : r.track.states().front().origin;
}

Truth truth_of(const ReplayReport& r) {
  if (r.reference.size() < 2) return std::nullopt;
  return sensors::ReferenceTrajectory(r.reference, LocalFrame(origin_of(r)));
}

void add(Line& line, const Eigen::Vector3d& p) {
  line.x.push_back(p.x());
  line.y.push_back(p.y());
}

void interrupt(Line& line) {
  line.x.push_back(nan);
  line.y.push_back(nan);
}

// Whether a replay that ended early came there.
bool replayed(const ReplayReport& r, Time stamp) {
  return !r.track.states().empty() && stamp <= r.track.states().back().stamp;
}

Line truth_line(const ReplayReport& r, const sensors::ReferenceTrajectory& truth) {
  Line line{"truth", {}, {}};
  for (const ReferencePose& row : r.reference) {
    if (!replayed(r, row.stamp)) break;
    if (const auto pose = truth.pose(row.stamp)) add(line, pose->translation());
  }
  return line;
}

Line fused_line(const ReplayReport& r) {
  Line line{"fused", {}, {}};
  Time last{};
  for (const NavState& s : r.track.states()) {
    if (!line.x.empty() && s.stamp - last > std::chrono::seconds(1)) interrupt(line);
    add(line, s.position_enu);
    last = s.stamp;
  }
  return line;
}

std::optional<Eigen::Isometry3d> fused_pose(const ReplayReport& r, Time stamp) {
  for (const NavState& s : r.track.states()) {
    if (s.stamp < stamp) continue;
    return Eigen::Translation3d(s.position_enu) * Eigen::Isometry3d(rotation_enu_body(s.attitude));
  }
  return std::nullopt;
}

Line dead_reckoned_line(const ReplayReport& r, const DeadReckoning& way, const Truth& truth) {
  Line line{way.name + " alone", {}, {}, Line::Look::dashed};
  std::optional<Eigen::Isometry3d> T_enu_first;
  for (std::size_t i = 0; i < way.trajectory.poses.size(); ++i) {
    const Eigen::Isometry3d& pose = way.trajectory.poses[i];
    if (!T_enu_first) {
      const Time stamp = way.trajectory.stamps[i];
      const auto begin = truth ? truth->pose(stamp) : fused_pose(r, stamp);
      if (!begin) continue;
      T_enu_first = *begin * pose.inverse();
    }
    add(line, (*T_enu_first * pose).translation());
  }
  return line;
}

// One quantity of the state: what it is, its standard deviation, and the truth's.
struct Quantity {
  const char* name;
  const char* unit;
  std::function<double(const NavState&)> value, sigma;
  std::function<double(const Eigen::Isometry3d&)> truth;
  bool wraps = false;  // degrees of a circle
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

Plot error_plot(const ReplayReport& r, const Truth& truth, const Quantity& q, Time first) {
  Plot plot{truth ? std::string("Error ") + q.name : std::string("Uncertainty ") + q.name, "s",
            q.unit};
  web::Band band{"3 sigma", {}, {}, {}};
  Line error{"fused minus truth", {}, {}};
  for (const NavState& s : r.track.states()) {
    const double t = to_seconds(s.stamp - first);
    const double spread = sigmas * q.sigma(s);
    band.x.push_back(t);
    band.low.push_back(-spread);
    band.high.push_back(spread);
    const auto pose = truth ? truth->pose(s.stamp) : std::nullopt;
    double off = pose ? q.value(s) - q.truth(*pose) : nan;
    if (q.wraps) off = std::remainder(off, 360.0);
    error.x.push_back(t);
    error.y.push_back(off);
  }
  plot.bands.push_back(std::move(band));
  if (truth) plot.lines.push_back(std::move(error));
  return plot;
}

Plot speed_plot(const ReplayReport& r, Time first) {
  Plot plot{"Speed", "s", "km/h"};
  constexpr double km_h = 3.6;
  Line fused{"fused", {}, {}}, truth{"truth", {}, {}};
  for (const NavState& s : r.track.states()) {
    fused.x.push_back(to_seconds(s.stamp - first));
    fused.y.push_back(km_h * s.velocity_enu.head<2>().norm());
  }
  for (const ReferencePose& row : r.reference) {
    if (!replayed(r, row.stamp)) break;
    truth.x.push_back(to_seconds(row.stamp - first));
    truth.y.push_back(km_h * row.velocity_enu.head<2>().norm());
  }
  if (!truth.x.empty()) plot.lines.push_back(std::move(truth));
  plot.lines.push_back(std::move(fused));
  return plot;
}

}  // namespace

web::Plot trajectory_map(const ReplayReport& r) {
  const Truth truth = truth_of(r);
  Plot plot{"Way of the vehicle", "east, m", "north, m", {}, true};
  if (truth) plot.lines.push_back(truth_line(r, *truth));
  plot.lines.push_back(fused_line(r));
  for (const DeadReckoning& way : r.dead_reckoning) {
    Line line = dead_reckoned_line(r, way, truth);
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  if (r.roads != nullptr && (truth || !r.track.states().empty()))
    plot.roads = match::road_lines(*r.roads, origin_of(r), plot.lines, surroundings);
  return plot;
}

std::vector<web::Plot> state_plots(const ReplayReport& r) {
  if (r.track.states().empty()) return {};
  const Truth truth = truth_of(r);
  const Time first =
      r.reference.empty() ? r.track.states().front().stamp : r.reference.front().stamp;
  std::vector<Plot> plots;
  for (const Quantity& q : quantities()) plots.push_back(error_plot(r, truth, q, first));
  plots.push_back(speed_plot(r, first));
  return plots;
}

}  // namespace maploop::report
