#include "runtime/vehicle/health/watchdog.h"

#include <fmt/format.h>

#include <algorithm>

namespace maploop::vehicle {
namespace {

std::string seconds(Duration duration) {
  return fmt::format("{:.3g} s", to_seconds(duration));
}

std::string waiting_for(const StageFacts& facts) {
  return facts.waits_for.empty() ? "" : ", waiting for '" + facts.waits_for + "'";
}

}  // namespace

Watchdog::Watchdog(const StageSpec& stage, Kind kind, Time start, MonotonicTime wall_start)
    : stage_(stage), kind_(kind), moved_(start), wall_moved_(wall_start), judged_(start) {}

Duration Watchdog::patience(const StageSpec& stage) {
  return std::max(stages::health.period, from_seconds(3.0 / stage.min_rate));
}

std::vector<std::string> Watchdog::look(Time now, MonotonicTime wall_now, const StageFacts& facts) {
  if (stage_.min_rate <= 0.0) return {};
  now = std::max(now, facts.newest.value_or(now));
  std::vector<std::string> wrong;
  const std::string still = stillness(now, wall_now, facts);
  if (facts.count > count_) {
    count_ = facts.count;
    moved_ = now;
    wall_moved_ = wall_now;
  }
  judge_rate(now, facts.count);
  if (!still.empty()) {
    wrong.push_back(still);
  } else if (!rate_verdict_.empty()) {
    wrong.push_back(rate_verdict_);
  }
  return wrong;
}

std::string Watchdog::stillness(Time now, MonotonicTime wall_now, const StageFacts& facts) const {
  const bool moves = facts.count > count_ && !facts.newest;
  if (moves) return {};
  const Duration wall_still = wall_now - wall_moved_;
  if (kind_ == Kind::fed && facts.waiting > 0 && wall_still >= patience(stage_)) {
    return fmt::format("{}: stuck for {} with {} samples before it{}", stage_.name,
                       seconds(wall_still), facts.waiting, waiting_for(facts));
  }
  const Duration still = now - facts.newest.value_or(moved_);
  if (still < patience(stage_)) return {};
  if (facts.count > 0)
    return fmt::format("{}: stale, nothing new for {}", stage_.name, seconds(still));
  return fmt::format(
      "{}: silent since the start, {} ago{}", stage_.name, seconds(still),
      kind_ == Kind::driver ? "; is the sensor on, and connected?" : waiting_for(facts));
}

void Watchdog::judge_rate(Time now, std::uint64_t count) {
  const Duration since = now - judged_;
  if (since < patience(stage_)) return;
  // One sample more or less may come from where the interval was cut.
  const auto samples = static_cast<double>(count - count_judged_);
  const double interval = to_seconds(since);
  rate_verdict_.clear();
  if ((samples + 1.0) / interval < stage_.min_rate ||
      (samples - 1.0) / interval > stage_.max_rate) {
    rate_verdict_ =
        fmt::format("{}: {:.3g} Hz over {}, {:.3g} to {:.3g} Hz expected", stage_.name,
                    samples / interval, seconds(since), stage_.min_rate, stage_.max_rate);
  }
  judged_ = now;
  count_judged_ = count;
}

}  // namespace maploop::vehicle
