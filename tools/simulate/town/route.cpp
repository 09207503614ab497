#include "tools/simulate/town/route.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <stdexcept>
#include <string>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using Route = std::vector<DirectedStreet>;

Eigen::Vector2d first_direction(const Streets& streets, DirectedStreet d) {
  const auto& line = streets.streets[d.street].centreline;
  return d.forward ? Eigen::Vector2d(line[1] - line[0])
                   : Eigen::Vector2d(line[line.size() - 2] - line.back());
}

Eigen::Vector2d last_direction(const Streets& streets, DirectedStreet d) {
  return -first_direction(streets, {d.street, !d.forward});
}

// Extends a route until it is long enough.
void walk(const Streets& streets, const Directions& directions, std::size_t place, double metres,
          std::uint64_t seed, Route& route) {
  Random random(seed, 3);
  std::vector<int> driven(streets.streets.size(), 0);
  double length = 0.0;
  for (const DirectedStreet& d : route) {
    ++driven[d.street];
    length += streets.streets[d.street].length();
  }
  while (length < metres) {
    constexpr double never = 1e3;
    const DirectedStreet* best = nullptr;
    double best_cost = 0.0;
    for (const DirectedStreet& exit : directions.exits(place)) {
      const bool wrong = !directions.is_through(exit) ||
                         (!route.empty() && !directions.follows(route.back(), exit));
      const double cost =
          (wrong ? never : 0.0) + 2.0 * driven[exit.street] + random.uniform(0.0, 1.5);
      if (!best || cost < best_cost) {
        best = &exit;
        best_cost = cost;
      }
    }
    if (!best || best_cost >= never)
      throw std::runtime_error("the route comes to a dead end; choose another seed or route");
    route.push_back(*best);
    ++driven[best->street];
    length += streets.streets[best->street].length();
    place = streets.end(*best);
  }
}

// Dijkstra's algorithm on directed streets, which excludes turning back. Returns an empty route if
// there is no way.
Route shortest(const Streets& streets, const Directions& directions,
               std::optional<DirectedStreet> before, std::size_t from, std::size_t to) {
  struct Reached {
    double length = std::numeric_limits<double>::infinity();
    std::optional<DirectedStreet> before;
  };
  std::vector<Reached> reached(2 * streets.streets.size());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](DirectedStreet d, double length, std::optional<DirectedStreet> by) {
    length += streets.streets[d.street].length();
    if (length >= reached[slot_of(d)].length) return;
    reached[slot_of(d)] = {length, by};
    open.emplace(length, slot_of(d));
  };
  for (const DirectedStreet& exit : directions.exits(from))
    if (!before || directions.follows(*before, exit)) reach(exit, 0.0, std::nullopt);
  while (!open.empty()) {
    const auto [length, at] = open.top();
    open.pop();
    const DirectedStreet here{at / 2, at % 2 == 1};
    if (length > reached[at].length) continue;
    if (streets.end(here) == to) {
      Route route{here};
      while (const auto by = reached[slot_of(route.back())].before) route.push_back(*by);
      std::reverse(route.begin(), route.end());
      return route;
    }
    for (const DirectedStreet& exit : directions.exits(streets.end(here)))
      if (directions.follows(here, exit)) reach(exit, length, here);
  }
  return {};
}

}  // namespace

double fastest(const Streets& streets) {
  double most = 0.0;
  for (const Street& street : streets.streets) most = std::max(most, street.speed_limit);
  return most;
}

std::size_t nearest_junction(const Streets& streets, const Eigen::Vector2d& place) {
  const auto nearest = std::min_element(streets.junctions.begin(), streets.junctions.end(),
                                        [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                                          return (a - place).norm() < (b - place).norm();
                                        });
  return static_cast<std::size_t>(nearest - streets.junctions.begin());
}

Directions::Directions(const Streets& streets)
    : streets_(&streets), exits_(streets.exits()), through_(2 * streets.streets.size(), true) {
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& exits : exits_)
      for (const DirectedStreet& d : exits) {
        if (!is_through(d)) continue;
        const auto& on = exits_[streets.end(d)];
        const bool goes_on = std::any_of(on.begin(), on.end(), [&](const DirectedStreet& next) {
          return is_through(next) && follows(d, next);
        });
        if (goes_on) continue;
        through_[slot_of(d)] = false;
        changed = true;
      }
  }
}

bool Directions::has_exit(std::size_t junction) const {
  return std::any_of(exits_[junction].begin(), exits_[junction].end(),
                     [this](const DirectedStreet& d) { return is_through(d); });
}

bool Directions::follows(DirectedStreet before, DirectedStreet next) const {
  constexpr double back = -0.866;  // cosine of 150 degrees
  if (next.street == before.street) return false;
  return last_direction(*streets_, before)
             .normalized()
             .dot(first_direction(*streets_, next).normalized()) > back;
}

std::vector<DirectedStreet> make_route(const Streets& streets, std::size_t start, double metres,
                                       std::uint64_t seed) {
  Route route;
  walk(streets, Directions(streets), start, metres, seed, route);
  return route;
}

std::vector<DirectedStreet> make_route(const Streets& streets, const std::vector<std::size_t>& via,
                                       double metres, std::uint64_t seed) {
  const Directions directions(streets);
  Route route;
  for (std::size_t i = 1; i < via.size(); ++i) {
    if (via[i] == via[i - 1]) continue;
    const auto before = route.empty() ? std::nullopt : std::optional(route.back());
    const Route part = shortest(streets, directions, before, via[i - 1], via[i]);
    if (part.empty())
      throw std::runtime_error("no way leads from place " + std::to_string(i) +
                               " of the route to " + std::to_string(i + 1));
    route.insert(route.end(), part.begin(), part.end());
  }
  walk(streets, directions, via.back(), metres, seed, route);
  return route;
}

Corridor corridor(const Streets& streets, const std::vector<DirectedStreet>& route, double reach) {
  constexpr double cell = 30.0;  // m
  NearCells near(cell, static_cast<long long>(reach / cell));
  for (const DirectedStreet& d : route)
    for (const Eigen::Vector2d& p : streets.streets[d.street].centreline) near.add(p);
  constexpr auto none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> new_junction(streets.junctions.size(), none);
  std::vector<std::size_t> new_street(streets.streets.size(), none);
  Corridor result;
  const auto keep = [&](std::size_t junction) {
    if (new_junction[junction] == none) {
      new_junction[junction] = result.streets.junctions.size();
      result.streets.junctions.push_back(streets.junctions[junction]);
    }
    return new_junction[junction];
  };
  for (std::size_t i = 0; i < streets.streets.size(); ++i) {
    const auto& line = streets.streets[i].centreline;
    if (std::none_of(line.begin(), line.end(),
                     [&](const Eigen::Vector2d& p) { return near.contains(p); }))
      continue;
    new_street[i] = result.streets.streets.size();
    Street street = streets.streets[i];
    street.from = keep(street.from);
    street.to = keep(street.to);
    result.streets.streets.push_back(std::move(street));
  }
  for (const DirectedStreet& d : route) result.route.push_back({new_street[d.street], d.forward});
  return result;
}

}  // namespace maploop::simulate
