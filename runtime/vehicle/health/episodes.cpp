#include "runtime/vehicle/health/episodes.h"

#include <fmt/format.h>

namespace maploop::vehicle {
namespace {

std::string seconds(Duration duration) {
  return fmt::format("{:.1f} s", to_seconds(duration));
}

std::string before(const Episodes& episodes) {
  if (episodes.count < 2) return {};
  return fmt::format(" ({} times, {} in all; this is the last)", episodes.count,
                     seconds(episodes.total));
}

}  // namespace

void UseWatch::judge(Time t) {
  const bool bad = 2 * wrong_ > all_;
  if (bad) {
    const auto most =
        std::max_element(tallies_.begin(), tallies_.end(),
                         [](const Tally& a, const Tally& b) { return a.count < b.count; });
    const Episode episode{begin_, t, wrong_, all_, most->reason};
    refusals_.goes_on ? refusals_.extend(episode) : refusals_.begin(episode);
    if (refusals_.named == Time{}) refusals_.named = t;
  }
  if (bad || refusals_.goes_on) {
    refusals_.goes_on = bad;
    published_.back() = refusals_;
    published_.publish();
  }
  begin_ = t;
  all_ = wrong_ = 0;
  tallies_ = {};
}

std::string UseWatch::sentence(Time origin) {
  if (const Episodes* news = published_.latest()) received_ = *news;
  if (received_.count == 0) return {};
  const Episode& last = received_.last;
  const std::string from = seconds(last.begin - origin);
  const bool goes_on = received_.goes_on;
  return fmt::format(
      "{} {} {} of {}{} {} {}{}: {}", stage_, goes_on ? judgement_.now : judgement_.then,
      last.wrong, goes_on ? "the last " : "", last.all, what_,
      goes_on ? "since " + from : "from " + from + " to " + seconds(last.end - origin),
      before(received_), last.reason);
}

std::optional<Naming> UseWatch::naming() {
  if (const Episodes* news = published_.latest()) received_ = *news;
  if (received_.named == Time{}) return std::nullopt;
  return Naming{fmt::format("{} {} {}", stage_, judgement_.now, what_), received_.named};
}

std::string outage_sentence(std::string_view sensor, const Episodes& outages, Time origin) {
  if (outages.count == 0) return {};
  return fmt::format("{}: silent for {} from {} on{}", sensor, seconds(outages.last.length()),
                     seconds(outages.last.begin - origin), before(outages));
}

}  // namespace maploop::vehicle
