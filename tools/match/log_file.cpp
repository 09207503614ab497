// Reads tracks and matches from LCM logs.
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mapmatch/nav_matcher.h"
#include "mapmatch/visual_course.h"
#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "sensors/replay/log_events.h"
#include "tools/match/match_score.h"

namespace maploop::match {
namespace {

using lcm_log::LogEvent;

// Reads a plain or .gz file. Throws std::runtime_error naming the file if it cannot be read or is
// damaged.
void visit_log(const std::filesystem::path& file,
               const std::function<void(const LogEvent&)>& visit) {
  const auto log = sensors::open_log(file, schema::own_schema());
  for (auto item = log->next(); item != sensors::LogEvents::Item::end; item = log->next()) {
    if (item == sensors::LogEvents::Item::damage)
      throw std::runtime_error(file.string() + " is damaged at byte " +
                               std::to_string(log->damage().begin) + " (" + log->damage().reason +
                               "); 'maploop log recover' makes a sound one of it");
    visit(log->event());
  }
}

// Decodes an event as one of our structs. Throws std::runtime_error if it is not such a message.
template <class Lcm>
auto decoded(const LogEvent& event, const std::filesystem::path& file) {
  const std::string where = file.string() + ": event " + std::to_string(event.number) + " on " +
                            std::string(event.channel) + ": ";
  Lcm message;
  if (!schema::checked_decode(schema::own_schema(), event.data, message))
    throw std::runtime_error(where + "no " + Lcm::getTypeName() + " of this version");
  try {
    return from_lcm(message);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(where + e.what());
  }
}

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

bool is_lcm_log(const std::filesystem::path& file) {
  constexpr std::string_view sync = "\xed\xa1\xda\x01";
  std::string begin(sync.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), std::ssize(begin));
  return begin == sync || file.string().ends_with(".lcmlog.gz") || sensors::is_own_recording(file);
}

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
  if (fixes.empty())
    throw std::runtime_error(file.string() +
                             " holds neither NAV_STATE nor GNSS_FIX; is it a log of 'maploop "
                             "replay --record'?");
  return fixes;
}

std::vector<TimedMatch> read_log_matches(const std::filesystem::path& file) {
  std::vector<TimedMatch> matches;
  visit_log(file, [&](const LogEvent& event) {
    if (event.channel != channel_names::map_match) return;
    matches.push_back(timed_match(decoded<maploop_lcm::map_match_t>(event, file)));
  });
  if (matches.empty())
    throw std::runtime_error(file.string() +
                             " holds no MAP_MATCH; was it recorded with 'maploop replay --map'?");
  return matches;
}

}  // namespace maploop::match
