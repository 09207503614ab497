#include "tools/match/driven_route.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <queue>
#include <utility>

namespace maploop::match {
namespace {

using mapmatch::DirectedLink;
using mapmatch::MatchResult;
using mapmatch::RoadNetwork;

constexpr double forbidden = 1000.0;     // m that a forbidden turn or direction counts for
constexpr double least_reach = 100.0;    // m between two fixes, for errors of both ...
constexpr double reach_per_metre = 3.0;  // ... and times the straight line
constexpr double fastest = 70.0;         // m/s

// A way that has left its first link.
struct Way {
  double cost = 0.0, length = 0.0;  // m of the links in between
  std::vector<DirectedLink> links;  // the last is not yet driven
  bool operator<(const Way& other) const { return cost > other.cost; }
};

// Builds a route fix by fix.
class RouteBuilder {
 public:
  RouteBuilder(const RoadNetwork& network, double max_gap) : network_(network), max_gap_(max_gap) {}

  RoutePlace add(const MatchResult& now) {
    if (!before_ || !go_on(now)) begin(now);
    RouteStep& step = route.pieces.back().back();
    step.to = std::max(step.to, now.along);
    step.left = now.stamp;
    step.probability += now.probability;
    ++step.fixes;
    before_ = &now;
    return {route.pieces.size() - 1, driven_ + step.length()};
  }

  void leave_road() { before_ = nullptr; }

  DrivenRoute finish() {
    for (DrivenRoute::Piece& piece : route.pieces) {
      double last = 0.0;
      for (RouteStep& step : piece) {
        step.probability =
            step.fixes > 0 ? step.probability / static_cast<double>(step.fixes) : last;
        last = step.probability;
      }
    }
    return std::move(route);
  }

  DrivenRoute route;

 private:
  void begin(const MatchResult& now) {
    route.pieces.push_back({{now.link, now.along, now.along, now.stamp, now.stamp}});
    driven_ = 0.0;
  }

  bool go_on(const MatchResult& now) {
    if (to_seconds(now.stamp - before_->stamp) > max_gap_) return false;
    if (now.link == before_->link) return true;
    RouteStep& last = route.pieces.back().back();
    if (now.link == last.link.reversed()) {  // a U-turn on the road
      driven_ += last.length();
      const double from = std::min(network_.link(now.link.link).length - last.to, now.along);
      enter({now.link, from, from, last.left, now.stamp});
      return true;
    }
    const double straight = (now.point.position - before_->point.position).norm();
    const double farthest = fastest * to_seconds(now.stamp - before_->stamp);
    const auto between =
        links_between(network_, last.link, now.link,
                      least_reach + std::min(reach_per_metre * straight, farthest));
    if (!between || !can_drive(*between, now)) return false;
    drive_on(*between, now);
    return true;
  }

  // Returns the metres from the end of the route to this place, if these links are in between.
  double length_to(const std::vector<DirectedLink>& between, const MatchResult& now) const {
    const RouteStep& last = route.pieces.back().back();
    double length = network_.link(last.link.link).length - last.to + now.along;
    for (const DirectedLink link : between) length += network_.link(link.link).length;
    return length;
  }

  // Whether a vehicle can have driven there since the fix before, give or take the errors of both.
  bool can_drive(const std::vector<DirectedLink>& between, const MatchResult& now) const {
    return length_to(between, now) <=
           least_reach + fastest * to_seconds(now.stamp - before_->stamp);
  }

  // Drives the rest of the last link, the links in between, and the beginning of the new one.
  void drive_on(const std::vector<DirectedLink>& between, const MatchResult& now) {
    RouteStep& last = route.pieces.back().back();
    const double whole = length_to(between, now);
    const Time start = last.left;
    double driven = network_.link(last.link.link).length - last.to;
    const auto at = [&] {
      return start + from_seconds(whole > 0.0 ? to_seconds(now.stamp - start) * driven / whole : 0);
    };
    last.to = network_.link(last.link.link).length;
    last.left = at();
    driven_ += last.length();
    for (const DirectedLink link : between) {
      const Time entered = at();
      driven += network_.link(link.link).length;
      enter({link, 0.0, network_.link(link.link).length, entered, at()});
      driven_ += network_.link(link.link).length;
    }
    enter({now.link, 0.0, 0.0, at(), now.stamp});
  }

  void enter(const RouteStep& step) { route.pieces.back().push_back(step); }

  const RoadNetwork& network_;
  double max_gap_;  // s
  const MatchResult* before_ = nullptr;
  double driven_ = 0.0;  // m of the piece until the last step
};

}  // namespace

std::optional<std::vector<DirectedLink>> links_between(const RoadNetwork& network,
                                                       DirectedLink from, DirectedLink to,
                                                       double reach) {
  std::priority_queue<Way> open;
  std::map<std::pair<std::uint32_t, bool>, double> driven;  // the shortest way to each link, m
  const auto leave = [&](const Way& way, DirectedLink link) {
    for (const DirectedLink exit : network.exits(network.end_junction(link))) {
      Way next = way;
      const bool legal = network.allowed(exit) && network.allowed_turn(link, exit);
      next.cost += legal && exit != link.reversed() ? 0.0 : forbidden;
      next.links.push_back(exit);
      open.push(std::move(next));
    }
  };
  leave({}, from);
  while (!open.empty()) {
    Way way = open.top();
    open.pop();
    const DirectedLink link = way.links.back();
    if (link == to) {
      way.links.pop_back();
      return way.links;
    }
    const auto [before, is_new] = driven.emplace(std::pair(link.link, link.forward), way.length);
    if (!is_new && way.length >= before->second) continue;
    before->second = way.length;
    const double length = network.link(link.link).length;
    way.length += length;
    way.cost += length;
    if (way.length <= reach) leave(way, link);
  }
  return {};
}

DrivenRoute driven_route(const MatchedTrack& track, const RoadNetwork& network) {
  RouteBuilder builder(network, track.max_gap);
  builder.route.places.resize(track.fixes.size());
  for (const std::size_t i : track.used()) {
    if (track.results[i].on_road) {
      builder.route.places[i] = builder.add(track.results[i]);
    } else {
      builder.leave_road();
    }
  }
  return builder.finish();
}

}  // namespace maploop::match
