#include "mapmatch/one_way_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "mapmatch/dead_ends.h"
#include "mapmatch/foot_point.h"
#include "mapmatch/road_network.h"
#include "msgs/frames.h"
#include "msgs/input_limits.h"

namespace maploop::mapmatch {
namespace {

// A carriageway is at most so far from the opposite one of its road, and nearly parallel to it.
constexpr double farthest = 40.0;  // m
constexpr double parallel = radians(20.0);
constexpr double spacing = 20.0;        // m, between the places that are compared
constexpr double bend = radians(60.0);  // from one link of a carriageway to the next
constexpr double least_seen = 0.25;     // share of the places where there is an opposite one
constexpr std::size_t most_near =
    10'000;                        // segments around a place; with more, sides are not judged
constexpr double one_sided = 0.8;  // least share of the compared places on one side

// Returns the names that a road has; those of several are separated by semicolons.
std::vector<std::string_view> names(std::string_view text) {
  std::vector<std::string_view> names;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    std::string_view name = text.substr(0, end);
    while (name.starts_with(' ')) name.remove_prefix(1);
    if (!name.empty()) names.push_back(name);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return names;
}

// Returns whether two roads have the same class and a name in common ("B 10" and "B 10;B 3"), or
// none. The lanes of car parks and yards are on either side of each other.
bool same_road(const Road& a, const Road& b) {
  if (a.roundabout || b.roundabout || a.road_class != b.road_class ||
      a.road_class >= RoadClass::service) {
    return false;
  }
  if (a.name.empty() && b.name.empty()) return true;
  for (const std::string_view name : names(a.name)) {
    const auto others = names(b.name);
    if (std::find(others.begin(), others.end(), name) != others.end()) return true;
  }
  return false;
}

// Returns on which side of a place on a one-way link the nearest opposite carriageway of its road
// is: -1 left, 1 right, 0 none; or nothing if more segments are near than any real place has.
std::optional<int> opposite_at(const RoadNetwork& network, DirectedLink link, double s) {
  const LinkPoint here = network.at(link, s);
  const Road& road = network.road_at(here.vertex);
  const Eigen::Vector2d& p = here.position;
  const Eigen::Vector2d right(here.direction.y(), -here.direction.x());
  double nearest = farthest;
  int side = 0;
  std::size_t near = 0;
  network.index().visit(
      Box{p.x() - farthest, p.y() - farthest, p.x() + farthest, p.y() + farthest},
      [&](const IndexedSegment& segment) {
        ++near;
        const Link& other = network.link(segment.link);
        if (segment.link == link.link || !other.one_way()) return;
        const Eigen::Vector2d a = network.vertex(segment.vertex).position();
        const Eigen::Vector2d step = network.vertex(segment.vertex + 1).position() - a;
        const Eigen::Vector2d driven = other.forward ? step : Eigen::Vector2d(-step);
        if (driven.dot(here.direction) > -std::cos(parallel) * step.norm()) return;
        const Eigen::Vector2d foot = a + foot_share(p, a, step) * step;
        const double distance = (foot - p).norm();
        const double across = right.dot(foot - p);
        if (distance >= nearest || std::abs(across) < distance * std::cos(parallel) ||
            !same_road(network.road_at(segment.vertex), road)) {
          return;
        }
        nearest = distance;
        side = across > 0.0 ? 1 : -1;
      });
  return near <= most_near ? std::optional(side) : std::nullopt;
}

// Counts the places where the opposite carriageway is to the left, to the right, or not there.
struct Sides {
  int left = 0, right = 0, none = 0;

  void add(const Sides& o) {
    left += o.left;
    right += o.right;
    none += o.none;
  }
  std::int8_t clear() const {
    const int seen = left + right;
    if (seen == 0 || seen < least_seen * (seen + none)) return 0;
    if (left >= one_sided * seen) return -1;
    return right >= one_sided * seen ? 1 : 0;
  }
};

// Returns nothing where too many segments are near.
std::optional<Sides> sides_of(const RoadNetwork& network, std::uint32_t link) {
  const Link& l = network.link(link);
  const int places = 1 + static_cast<int>(std::min(l.length / spacing, 50.0));
  Sides sides;
  for (int i = 0; i < places; ++i) {
    const auto side = opposite_at(network, {link, l.forward}, (i + 0.5) * l.length / places);
    if (!side) return {};
    ++(*side < 0 ? sides.left : *side > 0 ? sides.right : sides.none);
  }
  return sides;
}

// Carriageways are chains of one-way links of one road, each of which goes on in the next one.
class Carriageways {
 public:
  explicit Carriageways(const RoadNetwork& network) : first_(network.size()) {
    std::iota(first_.begin(), first_.end(), 0U);
    for (std::uint32_t junction = 0; junction < network.data().junctions.size(); ++junction) {
      const auto exits = network.exits(junction);
      if (exits.size() > input_limits::roads_at_node) continue;
      for (const DirectedLink to : exits) {
        for (const DirectedLink from : exits) {
          if (goes_on(network, from.reversed(), to))
            first_[first_of(from.link)] = first_of(to.link);
        }
      }
    }
  }

  // Returns the link that stands for the carriageway of a link.
  std::uint32_t first_of(std::uint32_t link) {
    while (first_[link] != link) link = first_[link] = first_[first_[link]];
    return link;
  }

 private:
  static bool goes_on(const RoadNetwork& network, DirectedLink from, DirectedLink to) {
    if (from.link == to.link || !network.link(from.link).one_way() ||
        !network.link(to.link).one_way() || !network.allowed(from) || !network.allowed(to)) {
      return false;
    }
    const LinkPoint end = network.at(from, network.link(from.link).length);
    const LinkPoint start = network.at(to, 0.0);
    return same_road(network.road_at(end.vertex), network.road_at(start.vertex)) &&
           end.direction.dot(start.direction) > std::cos(bend);
  }

  std::vector<std::uint32_t> first_;  // by link
};

// Finds the side of the opposite carriageway of each link.
void judge_sides(const RoadNetwork& network, OneWayChecks& checks) {
  Carriageways carriageways(network);
  std::vector<Sides> sides(network.size());  // of the carriageway that a link stands for
  for (std::uint32_t link = 0; link < network.size(); ++link) {
    if (!network.link(link).one_way()) continue;
    const auto own = sides_of(network, link);
    if (!own) return;
    sides[carriageways.first_of(link)].add(*own);
  }
  for (std::uint32_t link = 0; link < network.size(); ++link) {
    if (!network.link(link).one_way()) continue;
    const std::int8_t side = sides[carriageways.first_of(link)].clear();
    checks.of_link[link].opposite_side = side;
    checks.to_left += side < 0 ? 1 : 0;
    checks.to_right += side > 0 ? 1 : 0;
  }
}

}  // namespace

OneWayChecks check_one_ways(const RoadNetwork& network) {
  OneWayChecks checks{std::vector<OneWayCheck>(network.size())};
  judge_sides(network, checks);
  for (const std::uint32_t link : dead_ended_links(network)) checks.of_link[link].dead_ended = true;
  return checks;
}

}  // namespace maploop::mapmatch
