#include "runtime/vehicle/health/episodes.h"

#include <cstdio>

namespace maploop::vehicle {
namespace {

std::string seconds(Duration duration) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", to_seconds(duration));
  return text.data();
}

std::string before(const Episodes& episodes) {
  if (episodes.count < 2) return {};
  return " (" + std::to_string(episodes.count) + " times, " + seconds(episodes.total) +
         " in all; this is the last)";
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
  const std::string when =
      received_.goes_on ? " since " + from : " from " + from + " to " + seconds(last.end - origin);
  return std::string(stage_) + (received_.goes_on ? " refuses " : " refused ") +
         std::to_string(last.wrong) + " of " + (received_.goes_on ? "the last " : "") +
         std::to_string(last.all) + ' ' + std::string(what_) + when + before(received_) + ": " +
         last.reason;
}

std::string outage_sentence(std::string_view sensor, const Episodes& outages, Time origin) {
  if (outages.count == 0) return {};
  return std::string(sensor) + ": silent for " + seconds(outages.last.length()) + " from " +
         seconds(outages.last.begin - origin) + " on" + before(outages);
}

}  // namespace maploop::vehicle
