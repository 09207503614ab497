#include "runtime/vehicle/health/load_shedding.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace maploop::vehicle {
namespace {

constexpr std::uint32_t last_ten = (1U << 10U) - 1U;
constexpr int too_many = 3;                                // of the last ten steps
constexpr int least_patience = 100, most_patience = 3200;  // steps
constexpr int soon = 1000;                                 // steps

}  // namespace

LoadShedding::LoadShedding(const OverloadParameters& parameters, bool scans, bool images)
    : parameters_(parameters), levels_{Level{}}, patience_(least_patience), since_restored_(soon) {
  const auto leave_out = [&](int points, int pairs) {
    levels_.push_back(
        {std::max(points, levels_.back().points), std::max(pairs, levels_.back().pairs)});
  };
  if (parameters.shed == Shed::nothing) return;
  if (images && parameters.shed == Shed::images_first) leave_out(1, 2);
  if (scans) leave_out(2, 1);
  if (images && parameters.shed == Shed::scans_first) leave_out(1, 2);
}

void LoadShedding::worked(double share) {
  const std::scoped_lock lock(mutex_);
  since_restored_ = std::min(since_restored_ + 1, soon);
  recent_ = (recent_ << 1U | (share > parameters_.shed_at ? 1U : 0U)) & last_ten;
  with_room_ = share < parameters_.restore_at ? with_room_ + 1 : 0;
  if (std::popcount(recent_) >= too_many && level_ + 1 < levels_.size()) {
    patience_ = since_restored_ < soon ? std::min(2 * patience_, most_patience) : least_patience;
    go_to(level_ + 1);
  } else if (with_room_ >= patience_ && level_ > 0) {
    since_restored_ = 0;
    go_to(level_ - 1);
  }
}

// The measurements so far belong to another level, so they are forgotten.
void LoadShedding::go_to(std::size_t level) {
  level_ = level;
  recent_ = 0;
  with_room_ = 0;
}

LoadShedding::Level LoadShedding::level() const {
  const std::scoped_lock lock(mutex_);
  return levels_[level_];
}

std::string LoadShedding::sentence() const {
  const auto [points, pairs] = level();
  std::string used;
  if (points > 1) used = fmt::format("one of {} points of each scan", points);
  if (pairs > 1) used += fmt::format("{}one of {} image pairs", used.empty() ? "" : " and ", pairs);
  if (used.empty()) return {};
  return "overload: only " + used +
         " is used, because odometry did not keep its deadlines: close other programs, or lower "
         "the sensors' rates";
}

}  // namespace maploop::vehicle
