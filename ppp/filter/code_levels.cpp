#include "ppp/filter/code_levels.h"

#include <algorithm>
#include <cmath>

#include "ppp/filter/measurement.h"

namespace maploop::ppp {
namespace {

constexpr double largest_ratio = 100.0;
constexpr int enough_codes = position_unknowns + 1;  // fewer codes leave almost no residuals

}  // namespace

void CodeLevels::begin(double level) {
  std::fill(own_.begin(), own_.end(), Level{});
  all_ = level;
}

double CodeLevels::of(Satellite satellite) const {
  return std::max(1.0, own_[satellite.slot()].mean.value_or(all_));
}

void CodeLevels::add(Satellite satellite, double ratio) {
  own_[satellite.slot()].last = std::min(ratio, largest_ratio);
}

void CodeLevels::end_epoch(double interval, double time) {
  const double gain = 1.0 - std::exp(-interval / time);
  double sum = 0.0;
  int count = 0;
  for (Level& level : own_) {
    if (!level.last) continue;
    const double before = level.mean.value_or(all_);
    level.mean = before + gain * (*level.last - before);
    sum += *level.last;
    ++count;
    level.last.reset();
  }
  if (count >= enough_codes) all_ += gain * (sum / count - all_);
}

}  // namespace maploop::ppp
