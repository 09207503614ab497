#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/vehicle/faults/fault.h"
#include "tools/report/sections.h"
#include "tools/web/events.h"

namespace maploop::report {
namespace {

using web::Event;
using Level = Event::Level;
using Events = std::vector<Event>;

double drive_second(const Scene& scene, double second) {
  return scene.second(scene.report.result.begin) + second;
}

void add_outages(const Scene& scene, Events& all) {
  const tools::ReplayResult& r = scene.report.result;
  const auto add = [&](double start, double length, double error) {
    const double from = drive_second(scene, start);
    all.push_back({from, from + length, Level::warning,
                   fmt::format("no GNSS; the error grew to {:.1f} m", error), error_heading});
  };
  if (r.navigation && !r.navigation->outages.empty()) {
    for (const auto& o : r.navigation->outages) add(o.start, o.length, o.errors.max);
  } else {
    for (const auto& o : r.outage_ends) add(o.start, o.length, o.error);
  }
}

void add_faults(const Scene& scene, double last, Events& all) {
  for (const vehicle::FaultCount& f : scene.report.result.faults) {
    const vehicle::Fault fault = vehicle::parse_fault(f.fault);
    const double from = drive_second(scene, to_seconds(fault.start));
    all.push_back({from, fault.length ? from + to_seconds(*fault.length) : last, Level::error,
                   fmt::format("fault {}: {} struck", f.fault, f.struck), loss_heading});
  }
}

void add_largest_error(const Scene& scene, Events& all) {
  if (!scene.truth) return;
  double largest = 0.0, sigma = 0.0;
  Time when{};
  for (const NavState& s : scene.states()) {
    const auto pose = scene.truth->pose(s.stamp);
    if (!pose) continue;
    const double off = (s.position_enu - pose->translation()).head<2>().norm();
    if (!(off > largest)) continue;
    largest = off;
    sigma = std::sqrt(s.covariance(0, 0) + s.covariance(1, 1));
    when = s.stamp;
  }
  if (largest == 0.0) return;
  const double now = scene.second(when);
  all.push_back({now, now, Level::note,
                 fmt::format("the largest horizontal error, {:.2f} m; 3 sigma {:.2f} m", largest,
                             sigmas * sigma),
                 error_heading});
}

void add_restarts(const Scene& scene, Events& all) {
  const auto& states = scene.states();
  for (std::size_t i = 1; i < states.size(); ++i) {
    if (states[i].reinitializations <= states[i - 1].reinitializations) continue;
    const double now = scene.second(states[i].stamp);
    all.push_back({now, now, Level::error, "the filter began anew at a fix", loss_heading});
  }
}

void add_states_without_aid(const Scene& scene, Events& all) {
  NavStatus before = NavStatus::aided;
  for (const NavState& s : scene.states()) {
    const double now = scene.second(s.stamp);
    if (s.status != NavStatus::aided) {
      if (s.status != before)
        all.push_back({now, now, Level::warning, std::string(to_string(s.status)), {}});
      all.back().to = now;
    }
    before = s.status;
  }
}

void add_refused_odometry(const Scene& scene, Events& all) {
  Events refusals;
  std::uint64_t times = 0;  // of the event
  const auto& states = scene.states();
  for (std::size_t i = 1; i < states.size(); ++i) {
    const std::uint64_t before = states[i - 1].odometry_refused, now = states[i].odometry_refused;
    if (now <= before) continue;
    const std::size_t count = refusals.size();
    Event& event = extend(refusals, scene.second(states[i].stamp), 1.0,
                          {0, 0, Level::warning, {}, loss_heading});
    times = (refusals.size() > count ? 0 : times) + now - before;
    event.text = fmt::format("odometry refused, {} times", times);
  }
  all.insert(all.end(), refusals.begin(), refusals.end());
}

// A jump is a change of the horizontal position that the velocity does not explain.
void add_jumps(const Scene& scene, Events& all) {
  constexpr double least = 0.5;    // m
  constexpr double longest = 1.0;  // s between two states; beyond it is a gap
  Events jumps;
  double largest = 0.0;  // of the event
  const auto& states = scene.states();
  for (std::size_t i = 1; i < states.size(); ++i) {
    const NavState &before = states[i - 1], &s = states[i];
    const double step = to_seconds(s.stamp - before.stamp);
    const Eigen::Vector3d motion = 0.5 * step * (s.velocity_enu + before.velocity_enu);
    const double off = (s.position_enu - before.position_enu - motion).head<2>().norm();
    if (!(off > least && step < longest)) continue;
    const std::size_t count = jumps.size();
    Event& event =
        extend(jumps, scene.second(s.stamp), 1.0, {0, 0, Level::note, {}, error_heading});
    largest = jumps.size() > count ? off : std::max(largest, off);
    event.text = fmt::format("the position jumped by {:.1f} m", largest);
  }
  all.insert(all.end(), jumps.begin(), jumps.end());
}

void add_roads_left(const Scene& scene, Events& all) {
  constexpr double gap = 2.0;  // s between two matches
  Events left;
  for (const auto& [stamp, moment] : scene.report.pass.matches) {
    if (moment.phase != MatchPhase::off_road) continue;
    extend(left, scene.second(stamp), gap, {0, 0, Level::note, {}, road_heading}).text =
        "off the roads of the map";
  }
  all.insert(all.end(), left.begin(), left.end());
}

void add_epochs_without_position(const Scene& scene, Events& all) {
  Events without;
  std::uint64_t restarts = 0;
  for (const auto& [stamp, state] : scene.report.pass.ppp_states) {
    const double now = scene.second(stamp);
    if (state.status == PppStatus::none) {
      extend(without, now, 1.5, {0, 0, Level::warning, {}, ppp_heading}).text =
          "no position by PPP: " + state.message;
    }
    if (state.restarts > restarts)
      all.push_back({now, now, Level::error, "PPP started again", ppp_heading});
    restarts = state.restarts;
  }
  all.insert(all.end(), without.begin(), without.end());
}

void add_misses(const Scene& scene, const profile::Profile& times, Events& all) {
  if (scene.report.result.lockstep) return;
  for (const profile::WorstMiss& w : times.worst) {
    const double second = scene.second(w.miss.stamp);
    all.push_back({second, second, Level::error,
                   fmt::format("{} late: {:.1f} of {:.1f} ms", w.of,
                               to_milliseconds(w.miss.latency), to_milliseconds(w.deadline)),
                   latency_heading});
  }
}

}  // namespace

std::vector<Event> events(const Scene& scene, const profile::Profile& times) {
  Events all;
  const auto& states = scene.states();
  add_outages(scene, all);
  add_largest_error(scene, all);
  add_faults(scene, states.empty() ? 0.0 : scene.second(states.back().stamp), all);
  add_restarts(scene, all);
  add_states_without_aid(scene, all);
  add_refused_odometry(scene, all);
  add_jumps(scene, all);
  add_roads_left(scene, all);
  add_epochs_without_position(scene, all);
  add_misses(scene, times, all);
  web::sort_by_time(all);
  return all;
}

}  // namespace maploop::report
