#include "tools/replay/protection_score.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "msgs/protection_levels.h"
#include "tools/command/median.h"

namespace maploop::fusion_score {
namespace {

std::vector<ProtectedMoment> moments_of(const std::vector<NavProtection>& levels,
                                        const NavTrack& track,
                                        const std::vector<ReferencePose>& reference, Time from) {
  std::map<Time, const NavProtection*> at;
  for (const NavProtection& p : levels) at[p.stamp] = &p;
  std::vector<ProtectedMoment> moments;
  for (const ScoredState& scored : scored_states(track, reference)) {
    const NavState& state = *scored.state;
    const auto found = at.find(state.stamp);
    if (state.stamp < from || found == at.end()) continue;
    const NavProtection& p = *found->second;
    const Eigen::Vector2d error = (state.position_enu - scored.truth.translation()).head<2>();
    const TravelAxes axes = travel_axes(state.velocity_enu);
    moments.push_back({state.stamp,
                       p.doubted,
                       {std::abs(axes.along.dot(error)), p.along},
                       {std::abs(axes.across.dot(error)), p.across},
                       {error.norm(), p.horizontal}});
  }
  return moments;
}

ProtectionScore::Level level_of(const std::vector<ProtectedMoment>& moments,
                                ProtectedMoment::Error ProtectedMoment::*which) {
  ProtectionScore::Level result;
  std::vector<double> levels;
  for (const ProtectedMoment& moment : moments) {
    if (moment.doubted) continue;
    result.beyond += (moment.*which).beyond();
    levels.push_back((moment.*which).level);
  }
  result.median = tools::median(levels);
  return result;
}

}  // namespace

std::optional<ProtectionScore> score(const std::vector<NavProtection>& levels,
                                     const NavTrack& track,
                                     const std::vector<ReferencePose>& reference, Time from) {
  ProtectionScore result;
  result.moments = moments_of(levels, track, reference, from);
  if (result.moments.empty()) return std::nullopt;
  result.risk = levels.front().risk;
  result.along = level_of(result.moments, &ProtectedMoment::along);
  result.across = level_of(result.moments, &ProtectedMoment::across);
  result.horizontal = level_of(result.moments, &ProtectedMoment::horizontal);
  std::size_t below_5 = 0, below_10 = 0;
  for (const ProtectedMoment& moment : result.moments) {
    if (moment.doubted) {
      ++result.doubted;
      continue;
    }
    const ProtectedMoment::Error& error = moment.horizontal;
    result.largest_ratio = std::max(result.largest_ratio, error.ratio());
    below_5 += error.level < 5.0;
    below_10 += error.level < 10.0;
  }
  const auto all = static_cast<double>(result.moments.size());
  result.below_5 = static_cast<double>(below_5) / all;
  result.below_10 = static_cast<double>(below_10) / all;
  return result;
}

std::string to_text(const ProtectionScore& s) {
  const auto line = [&](const char* name, const ProtectionScore::Level& level) {
    return fmt::format("  {:20}{:8}{:10.2f}\n", name, level.beyond, level.median);
  };
  return fmt::format(
             "\nProtection levels     beyond  median m   (risk {:g}, {} moments, in {} of them an "
             "aid was doubted)\n",
             s.risk, s.moments.size(), s.doubted) +
         line("along the way", s.along) + line("across", s.across) +
         line("horizontal", s.horizontal) +
         fmt::format(
             "  The horizontal level is below 5 m in {:.1f} %, below 10 m in {:.1f} % of the "
             "moments.\n",
             100.0 * s.below_5, 100.0 * s.below_10);
}

}  // namespace maploop::fusion_score
