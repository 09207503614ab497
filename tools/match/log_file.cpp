// Reads tracks and matches from LCM logs.
#include <stdexcept>
#include <string>

#include "mapmatch/nav_matcher.h"
#include "mapmatch/visual_course.h"
#include "msgs/lcm/channel_names.h"
#include "tools/evaluate/log_messages.h"
#include "tools/match/match_score.h"

namespace maploop::match {
namespace {

using evaluation::decoded;
using evaluation::visit_log;
using lcm_log::LogEvent;

constexpr Duration state_period = std::chrono::milliseconds(100);  // least time between states

mapmatch::VehicleFix fix_of(const GnssFix& gnss) {
  mapmatch::VehicleFix fix;
  fix.stamp = gnss.stamp;
  fix.position = gnss.position;
  fix.covariance = gnss.position_covariance.topLeftCorner<2, 2>();
  return fix;
}

// Returns states at least 100 ms apart, each with the visual odometry that was available by then.
Track with_visual_course(const std::vector<NavState>& states,
                         const std::vector<RelativeMotion>& visual) {
  Track track;
  mapmatch::VisualCourse course;
  auto next = visual.begin();
  for (const NavState& state : states) {
    if (!track.empty() && state.stamp - track.back().stamp < state_period) continue;
    for (; next != visual.end() && next->available <= state.available; ++next) course.add(*next);
    track.push_back(mapmatch::fix_of(state));
    course.describe(track.back());
  }
  return track;
}

}  // namespace

Track read_log_track(const std::filesystem::path& file) {
  std::vector<NavState> states;
  std::vector<RelativeMotion> visual;
  Track fixes;
  visit_log(file, [&](const LogEvent& event) {
    if (event.channel == channel_names::nav_state) {
      states.push_back(decoded<maploop_lcm::nav_state_t>(event, file));
      if (states.back().status == NavStatus::uninitialized) states.pop_back();
    } else if (event.channel == channel_names::visual_odometry) {
      visual.push_back(decoded<maploop_lcm::relative_motion_t>(event, file));
    } else if (event.channel == channel_names::gnss_fix) {
      fixes.push_back(fix_of(decoded<maploop_lcm::gnss_fix_t>(event, file)));
    }
  });
  if (!states.empty()) return with_visual_course(states, visual);
  if (fixes.empty()) {
    throw std::runtime_error(file.string() +
                             " holds neither NAV_STATE nor GNSS_FIX; is it a log of 'maploop "
                             "replay --record'?");
  }
  return fixes;
}

std::vector<TimedMatch> read_log_matches(const std::filesystem::path& file) {
  std::vector<TimedMatch> matches;
  visit_log(file, [&](const LogEvent& event) {
    if (event.channel != channel_names::map_match) return;
    matches.push_back(timed_match(decoded<maploop_lcm::map_match_t>(event, file)));
  });
  if (matches.empty()) {
    throw std::runtime_error(file.string() +
                             " holds no MAP_MATCH; was it recorded with 'maploop replay --map'?");
  }
  return matches;
}

}  // namespace maploop::match
