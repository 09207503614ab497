#include "tools/replay/protection_score.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>

#include "msgs/protection_levels.h"
#include "tools/command/median.h"

namespace maploop::fusion_score {
namespace {

// Gathers one level's errors.
class LevelCounter {
 public:
  void add(double error, double level) {
    beyond_ += error > level;
    levels_.push_back(level);
    largest_ratio_ = std::max(largest_ratio_, error / level);
  }
  ProtectionScore::Level result() const { return {beyond_, tools::median(levels_)}; }
  std::size_t below(double limit) const {
    const auto below = std::count_if(levels_.begin(), levels_.end(),
                                     [limit](double level) { return level < limit; });
    return static_cast<std::size_t>(below);
  }
  double largest_ratio() const { return largest_ratio_; }
  std::size_t count() const { return levels_.size(); }

 private:
  std::size_t beyond_ = 0;
  std::vector<double> levels_;
  double largest_ratio_ = 0.0;
};

}  // namespace

std::optional<ProtectionScore> score(const std::vector<NavProtection>& levels,
                                     const NavTrack& track,
                                     const std::vector<ReferencePose>& reference, Time from) {
  std::map<Time, const NavProtection*> at;
  for (const NavProtection& p : levels) at[p.stamp] = &p;
  LevelCounter along, across, horizontal;
  std::size_t doubted = 0;
  for (const ScoredState& scored : scored_states(track, reference)) {
    const NavState& state = *scored.state;
    const auto found = at.find(state.stamp);
    if (state.stamp < from || found == at.end()) continue;
    const NavProtection& p = *found->second;
    if (p.doubted) {
      ++doubted;
      continue;
    }
    const Eigen::Vector2d error = (state.position_enu - scored.truth.translation()).head<2>();
    const TravelAxes axes = travel_axes(state.velocity_enu);
    along.add(std::abs(axes.along.dot(error)), p.along);
    across.add(std::abs(axes.across.dot(error)), p.across);
    horizontal.add(error.norm(), p.horizontal);
  }
  const std::size_t moments = along.count() + doubted;
  if (moments == 0) return std::nullopt;
  const auto share_below = [&](double limit) {
    return static_cast<double>(horizontal.below(limit)) / static_cast<double>(moments);
  };
  return ProtectionScore{levels.front().risk,
                         moments,
                         doubted,
                         along.result(),
                         across.result(),
                         horizontal.result(),
                         horizontal.largest_ratio(),
                         share_below(5.0),
                         share_below(10.0)};
}

std::string to_text(const ProtectionScore& s) {
  const auto line = [&](const char* name, const ProtectionScore::Level& level) {
    return fmt::format("  {:20}{:8}{:10.2f}\n", name, level.beyond, level.median);
  };
  return fmt::format(
             "\nProtection levels     beyond  median m   (risk {:g}, {} moments, in {} of them an "
             "aid was doubted)\n",
             s.risk, s.moments, s.doubted) +
         line("along the way", s.along) + line("across", s.across) +
         line("horizontal", s.horizontal) +
         fmt::format(
             "  The horizontal level is below 5 m in {:.1f} %, below 10 m in {:.1f} % of the "
             "moments.\n",
             100.0 * s.below_5, 100.0 * s.below_10);
}

}  // namespace maploop::fusion_score
