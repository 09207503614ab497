#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

#include "mapmatch/candidate_search.h"
#include "mapmatch/match_parameters.h"
#include "tools/match/baseline_matchers.h"

namespace maploop::match {
namespace {

using mapmatch::DirectedLink;
using mapmatch::NearLink;
using mapmatch::RoadNetwork;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double ellipse_margin = 12.0;   // m
constexpr double longest_detour = 200.0;  // m that a route may be longer than the straight line

// Finds distances along the roads from one junction, as far as `reach` (m).
class Distances {
 public:
  Distances(const RoadNetwork& network, std::uint32_t from, double reach) {
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    open.push({0.0, from});
    while (!open.empty()) {
      const auto [distance, junction] = open.top();
      open.pop();
      if (!found_.emplace(junction, distance).second) continue;
      for (const DirectedLink exit : network.exits(junction)) {
        const double there = distance + network.link(exit.link).length;
        if (network.allowed(exit) && there <= reach) open.push({there, network.end_junction(exit)});
      }
    }
  }

  double to(std::uint32_t junction) const {
    const auto known = found_.find(junction);
    return known == found_.end() ? infinite : known->second;
  }

 private:
  std::map<std::uint32_t, double> found_;
};

// A link, in its stored direction, that the vehicle may be on at one fix.
struct State {
  NearLink near;
  double score = -infinite;  // ln P of the likeliest path to it
  std::size_t from = 0;      // the state before on this path
};

struct Column {
  std::size_t fix = 0;
  Eigen::Vector2d place;
  std::vector<State> states;
  bool begins = false;  // no path leads here from the column before
};

class Trellis {
 public:
  Trellis(const RoadNetwork& network, double beta) : network_(network), beta_(beta) {}

  void add(std::size_t fix, const mapmatch::VehicleFix& at) {
    Column column{fix, network_.to_local(at.position), {}, false};
    find_near_links(network_, column.place, mapmatch::ErrorEllipse(at.covariance, ellipse_margin),
                    near_);
    const mapmatch::MatchParameters parameters;
    const double sigma = std::hypot(std::sqrt(0.5 * at.covariance.trace()), parameters.map_sigma);
    for (const NearLink& n : near_.all()) column.states.push_back({n});
    if (column.states.empty()) return;
    if (!columns_.empty()) reach(columns_.back(), column);
    column.begins = std::none_of(column.states.begin(), column.states.end(),
                                 [](const State& s) { return s.score > -infinite; });
    for (State& s : column.states) {
      if (column.begins) s.score = 0.0;
      s.score -= 0.5 * std::pow(s.near.distance / sigma, 2);
    }
    columns_.push_back(std::move(column));
  }

  // Returns the state of each column on the likeliest path, from the last to the first.
  template <class Take>
  void trace(const Take& take) const {
    std::size_t state = 0;
    bool known = false;
    for (std::size_t c = columns_.size(); c-- > 0;) {
      const std::vector<State>& states = columns_[c].states;
      if (!known) {
        const auto best =
            std::max_element(states.begin(), states.end(),
                             [](const State& a, const State& b) { return a.score < b.score; });
        state = static_cast<std::size_t>(best - states.begin());
      }
      take(columns_[c].fix, states[state].near);
      known = !columns_[c].begins;
      state = states[state].from;
    }
  }

 private:
  void reach(const Column& before, Column& now) {
    const double straight = (now.place - before.place).norm();
    const double limit = straight + longest_detour;
    std::map<std::uint32_t, Distances> known;  // by the junction that they are from
    const auto distances = [&](std::uint32_t junction) -> const Distances& {
      return known.try_emplace(junction, network_, junction, limit).first->second;
    };
    for (std::size_t i = 0; i < before.states.size(); ++i) {
      const State& from = before.states[i];
      if (!(from.score > -infinite)) continue;
      const DirectedLink link = from.near.link;
      const double length = network_.link(link.link).length;
      const Distances& ahead = distances(network_.end_junction(link));
      const Distances& behind = distances(network_.start_junction(link));
      for (State& to : now.states) {
        double route = infinite;
        if (to.near.link.link == link.link) route = std::abs(to.near.along - from.near.along);
        const double length_to = network_.link(to.near.link.link).length;
        for (const bool in_forward : {true, false}) {
          const DirectedLink in{to.near.link.link, in_forward};
          if (!network_.allowed(in)) continue;
          const double rest = in_forward ? to.near.along : length_to - to.near.along;
          const std::uint32_t entry = network_.start_junction(in);
          if (network_.allowed(link))
            route = std::min(route, length - from.near.along + ahead.to(entry) + rest);
          if (network_.allowed(link.reversed()))
            route = std::min(route, from.near.along + behind.to(entry) + rest);
        }
        if (route > limit) continue;
        const double score = from.score - std::abs(route - straight) / beta_;
        if (score > to.score) {
          to.score = score;
          to.from = i;
        }
      }
    }
  }

  const RoadNetwork& network_;
  double beta_;
  mapmatch::NearLinks near_;
  std::vector<Column> columns_;
};

}  // namespace

std::vector<MatchedFix> hidden_markov(const RoadNetwork& network, const Track& track, double beta) {
  constexpr double interval = 0.95;  // s
  Trellis trellis(network, beta);
  std::optional<Time> last;
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (last && to_seconds(track[i].stamp - *last) < interval) continue;
    trellis.add(i, track[i]);
    last = track[i].stamp;
  }
  std::vector<std::optional<DirectedLink>> links(track.size());
  std::vector<MatchedFix> matched(track.size());
  trellis.trace([&](std::size_t fix, const NearLink& near) {
    links[fix] = near.link;
    matched[fix] = on_segment(network, near.link, near.point.vertex, 1.0);
  });
  // The fixes between.
  std::optional<DirectedLink> before;
  std::vector<std::optional<DirectedLink>> after(track.size());
  for (std::size_t i = track.size(); i-- > 0;)
    after[i] = links[i] ? links[i] : i + 1 < track.size() ? after[i + 1] : std::nullopt;
  mapmatch::NearLinks near;
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (links[i]) {
      before = links[i];
      continue;
    }
    find_near_links(network, network.to_local(track[i].position),
                    mapmatch::ErrorEllipse(track[i].covariance, ellipse_margin), near);
    for (const NearLink& n : near.all()) {  // the nearest comes first
      if (n.link != before && n.link != after[i]) continue;
      matched[i] = on_segment(network, n.link, n.point.vertex, 1.0);
      break;
    }
  }
  return matched;
}

}  // namespace maploop::match
