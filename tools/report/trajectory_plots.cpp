#include "tools/report/trajectory_plots.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "msgs/frames.h"
#include "tools/match/road_lines.h"
#include "tools/report/error_plot.h"
#include "tools/report/frame.h"

namespace maploop::report {
namespace {

using web::Line;
using web::Plot;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double surroundings = 150.0;  // m, margin around the path in which roads are drawn

using Truth = std::optional<sensors::ReferenceTrajectory>;

void add(Line& line, const Eigen::Vector3d& p) {
  line.x.push_back(p.x());
  line.y.push_back(p.y());
}

void interrupt(Line& line) {
  line.x.push_back(nan);
  line.y.push_back(nan);
}

// Whether the replay, which may have ended early, reached this time.
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

Line ppp_line(const ReplayReport& r) {
  Line line{"PPP", {}, {}};
  const LocalFrame frame(origin_of(r));
  for (const auto& [stamp, state] : r.ppp) {
    if (state.status == PppStatus::none) {
      interrupt(line);
    } else {
      add(line, frame.to_enu(state.position));
    }
  }
  return line;
}

Line matched_line(const ReplayReport& r) {
  Line line{"matched", {}, {}, Line::Look::points};
  const LocalFrame frame(origin_of(r));
  for (const auto& [stamp, moment] : r.matches) {
    if (moment.on_road) add(line, frame.to_enu(moment.place));
  }
  return line;
}

ErrorSeries error_of(const ReplayReport& r, const Truth& truth, const Quantity& q, Time first) {
  ErrorSeries series{q.name, q.unit, "fused", {}, {}, {}};
  for (const NavState& s : r.track.states()) {
    const auto pose = truth ? truth->pose(s.stamp) : std::nullopt;
    double off = pose ? q.value(s) - q.truth(*pose) : nan;
    if (q.wraps) off = std::remainder(off, 360.0);
    series.seconds.push_back(to_seconds(s.stamp - first));
    series.error.push_back(off);
    series.sigma.push_back(q.sigma(s));
  }
  return series;
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
  if (Line ppp = ppp_line(r); !ppp.x.empty()) plot.lines.push_back(std::move(ppp));
  for (const DeadReckoning& way : r.dead_reckoning) {
    Line line = dead_reckoned_line(r, way, truth);
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  if (Line matched = matched_line(r); !matched.x.empty()) plot.lines.push_back(std::move(matched));
  if (r.roads != nullptr)
    plot.roads = match::road_lines(*r.roads, origin_of(r), plot.lines, surroundings);
  return plot;
}

std::vector<web::Plot> state_plots(const ReplayReport& r) {
  if (r.track.states().empty()) return {};
  const Truth truth = truth_of(r);
  const Time first = first_of(r);
  std::vector<Plot> plots;
  for (const Quantity& q : quantities()) plots.push_back(error_plot(error_of(r, truth, q, first)));
  plots.push_back(speed_plot(r, first));
  return plots;
}

}  // namespace maploop::report
