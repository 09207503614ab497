#include <stdexcept>

#include "mapmatch/nav_matcher.h"
#include "msgs/lcm/channel_names.h"
#include "tools/match/log_messages.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

constexpr Duration state_period = std::chrono::milliseconds(100);  // of those that are taken

mapmatch::VehicleFix fix_of(const GnssFix& gnss) {
  mapmatch::VehicleFix fix;
  fix.stamp = gnss.stamp;
  fix.position = gnss.position;
  fix.covariance = gnss.position_covariance.topLeftCorner<2, 2>();
  return fix;
}

}  // namespace

Track read_log_track(const std::filesystem::path& file) {
  Track states, fixes;
  visit_log(file, [&](const lcm_log::LogEvent& event) {
    if (event.channel == channel_names::nav_state) {
      const auto state = decoded<maploop_lcm::nav_state_t>(event, file);
      if (state.status == NavStatus::uninitialized) return;
      if (states.empty() || state.stamp - states.back().stamp >= state_period)
        states.push_back(mapmatch::fix_of(state));
    } else if (event.channel == channel_names::gnss_fix) {
      fixes.push_back(fix_of(decoded<maploop_lcm::gnss_fix_t>(event, file)));
    }
  });
  if (!states.empty()) return states;
  if (fixes.empty())
    throw std::runtime_error(file.string() +
                             " holds neither NAV_STATE nor GNSS_FIX; is it a log of 'maploop "
                             "replay --record'?");
  return fixes;
}

}  // namespace maploop::match
