#include "tools/experiment/ppp_map_statistics.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>

namespace maploop::experiments {
namespace {

// Of a part: what is summed without and with the map.
struct Sums {
  double without = 0.0, with = 0.0;
  std::size_t moments = 0;
};

// The 2.5 and 97.5 % quantiles of a value of sums over parts drawn with replacement.
template <class Value>
std::pair<double, double> bootstrap(const std::vector<Sums>& parts, Value&& value) {
  constexpr int draws = 2000;
  if (parts.empty()) return {0.0, 0.0};
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, parts.size() - 1);
  std::vector<double> values;
  for (int i = 0; i < draws; ++i) {
    Sums sum;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Sums& part = parts[any(random)];
      sum.without += part.without;
      sum.with += part.with;
    }
    values.push_back(value(sum));
  }
  std::sort(values.begin(), values.end());
  return {values[draws / 40], values[draws - 1 - draws / 40]};
}

Sums total(const std::vector<Sums>& parts) {
  Sums sum;
  for (const Sums& part : parts) {
    sum.without += part.without;
    sum.with += part.with;
    sum.moments += part.moments;
  }
  return sum;
}

double less_percent(double without, double with) {
  return without > 0.0 ? 100.0 * (1.0 - with / without) : 0.0;
}

double time_of(const Part& part, double PppMoment::*error, double limit, double from,
               const Chosen& chosen) {
  double since = from;
  for (const PppMoment& m : part) {
    if (m.time >= from && chosen(m) && std::abs(m.*error) > limit) since = m.time;
  }
  return since - from;
}

}  // namespace

std::vector<Part> cut_into(const Part& part, double seconds) {
  std::vector<Part> parts;
  double end = -1e300;
  for (const PppMoment& m : part) {
    if (m.time >= end) {
      parts.emplace_back();
      end = m.time + seconds;
    }
    parts.back().push_back(m);
  }
  return parts;
}

Reduction reduction(const std::vector<Part>& parts, bool across, const Chosen& chosen) {
  const auto without = across ? &PppMoment::across_free : &PppMoment::horizontal_free;
  const auto with = across ? &PppMoment::across_aided : &PppMoment::horizontal_aided;
  std::vector<Sums> sums;
  for (const Part& part : parts) {
    Sums sum;
    for (const PppMoment& m : part) {
      if (!chosen(m)) continue;
      sum.without += m.*without * m.*without;
      sum.with += m.*with * m.*with;
      ++sum.moments;
    }
    if (sum.moments > 0) sums.push_back(sum);
  }
  Reduction r;
  r.parts = sums.size();
  const Sums all = total(sums);
  r.moments = all.moments;
  if (r.moments == 0) return r;
  r.without = std::sqrt(all.without / static_cast<double>(all.moments));
  r.with = std::sqrt(all.with / static_cast<double>(all.moments));
  r.percent = less_percent(r.without, r.with);
  std::tie(r.low, r.high) = bootstrap(
      sums, [](const Sums& s) { return less_percent(std::sqrt(s.without), std::sqrt(s.with)); });
  return r;
}

TimeToStay time_to_stay(const std::vector<Part>& parts, double limit, double from,
                        const Chosen& chosen) {
  std::vector<Sums> sums;
  for (const Part& part : parts) {
    if (std::none_of(part.begin(), part.end(), chosen)) continue;
    sums.push_back({time_of(part, &PppMoment::across_free, limit, from, chosen),
                    time_of(part, &PppMoment::across_aided, limit, from, chosen), 1});
  }
  TimeToStay t;
  const Sums all = total(sums);
  if (all.moments == 0) return t;
  t.without = all.without / static_cast<double>(all.moments);
  t.with = all.with / static_cast<double>(all.moments);
  t.percent = less_percent(t.without, t.with);
  std::tie(t.low, t.high) =
      bootstrap(sums, [](const Sums& s) { return less_percent(s.without, s.with); });
  return t;
}

Recovery recovery(const std::vector<Part>& parts) {
  constexpr double after = 10.0;  // s
  Recovery r;
  for (const Part& part : parts) {
    if (part.empty()) continue;
    r.restorations += part.back().restorations;
    bool paused = false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const bool begins = part[i].paused && !paused;
      paused = part[i].paused;
      if (!begins) continue;
      ++r.pauses;
      const auto then =
          std::find_if(part.begin() + static_cast<std::ptrdiff_t>(i), part.end(),
                       [&](const PppMoment& m) { return m.time >= part[i].time + after; });
      if (then != part.end()) r.farthest = std::max(r.farthest, then->apart);
    }
  }
  return r;
}

}  // namespace maploop::experiments
