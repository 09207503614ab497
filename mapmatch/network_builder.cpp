#include "mapmatch/network_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "msgs/frames.h"
#include "msgs/input_limits.h"

namespace maploop::mapmatch {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double earth_radius = 6.371e6;       // m
constexpr double far_from_middle = 500'000.0;  // m
constexpr double min_segment = 0.001;  // m, so that two nodes at one position have a distance

// Connects one node of a way with the next.
struct Segment {
  std::uint32_t from = 0, to = 0;  // nodes
  std::uint32_t road = 0;
  bool used = false;
};

class Builder {
 public:
  explicit Builder(const MapExtract& map) : map_(map) {
    place_nodes();
    make_segments();
    list_segments_by_node();
  }

  NetworkData build() {
    find_junctions();
    for (std::uint32_t node = 0; node < map_.nodes.size(); ++node)
      if (junction_[node] != none) trace_from(node);
    for (const Segment& s : segments_) {  // the remaining segments are isolated rings
      if (s.used) continue;
      add_junction(s.from);
      trace_from(s.from);
    }
    list_exits();
    ban_turns();
    return std::move(data_);
  }

 private:
  void place_nodes() {
    if (map_.nodes.empty()) return;
    const Middle greenwich = middle(0.0), opposite = middle(180.0);
    data_.origin = (opposite.width < greenwich.width ? opposite : greenwich).place;
    const LocalFrame frame(data_.origin);
    double farthest = 0.0;
    place_.reserve(map_.nodes.size());
    for (const MapNode& n : map_.nodes) {
      place_.push_back(frame.to_enu({radians(n.latitude), radians(n.longitude), 0.0}).head<2>());
      farthest = std::max(farthest, place_.back().norm());
    }
    if (farthest > far_from_middle) {
      data_.warnings.push_back("it reaches " + std::to_string(std::lround(farthest / 1000.0)) +
                               " km from its middle, where distances are wrong by " +
                               std::to_string(std::lround(1000.0 * distortion(farthest))) +
                               " m per km: select a part of it with a box");
    }
  }

  struct Middle {
    Geodetic place;
    double width = 0.0;  // degrees
  };
  // Returns the middle of the box around all nodes, with longitudes relative to `meridian`
  // (degrees).
  Middle middle(double meridian) const {
    double south = 90.0, north = -90.0, west = 180.0, east = -180.0;
    for (const MapNode& n : map_.nodes) {
      const double longitude = std::remainder(n.longitude - meridian, 360.0);
      south = std::min(south, n.latitude);
      north = std::max(north, n.latitude);
      west = std::min(west, longitude);
      east = std::max(east, longitude);
    }
    return {
        {radians(0.5 * (south + north)), wrap_angle(radians(meridian + 0.5 * (west + east))), 0.0},
        east - west};
  }

  // Returns the share by which the tangent plane shortens distances this far away.
  static double distortion(double metres) { return 0.5 * std::pow(metres / earth_radius, 2); }

  std::uint32_t find(std::int64_t id) const {
    const MapNode* found = map_.find(id);
    return found != nullptr ? static_cast<std::uint32_t>(found - map_.nodes.data()) : none;
  }

  void make_segments() {
    std::size_t missing = 0;
    for (const MapWay& way : map_.ways) {
      const auto road = static_cast<std::uint32_t>(data_.roads.size());
      std::uint32_t last = none;
      bool drawn = false;
      for (const std::int64_t id : way.nodes) {
        const std::uint32_t node = find(id);
        if (node == none) {
          ++missing;
        } else if (last != none) {
          if (node == last) continue;
          segments_.push_back({last, node, road});
          drawn = true;
        }
        last = node;
      }
      if (drawn) data_.roads.push_back(way.road);
    }
    if (missing > 0) {
      data_.warnings.push_back(std::to_string(missing) +
                               " nodes of roads are missing in the map: their roads end there");
    }
  }

  void list_segments_by_node() {
    first_.assign(map_.nodes.size() + 1, 0);
    for (const Segment& s : segments_) {
      ++first_[s.from + 1];
      ++first_[s.to + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    at_node_.resize(2 * segments_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < segments_.size(); ++i) {
      at_node_[next[segments_[i].from]++] = i;
      at_node_[next[segments_[i].to]++] = i;
    }
  }

  // Returns whether traffic may leave a node along a segment, and whether it may arrive along it.
  std::pair<bool, bool> out_and_in(std::uint32_t node, const Segment& s) const {
    const Road& road = data_.roads[s.road];
    return s.from == node ? std::pair(road.forward, road.backward)
                          : std::pair(road.backward, road.forward);
  }

  void find_junctions() {
    junction_.assign(map_.nodes.size(), none);
    for (std::uint32_t node = 0; node < map_.nodes.size(); ++node) {
      const std::uint32_t degree = first_[node + 1] - first_[node];
      if (degree == 0) continue;
      bool passes = degree == 2;
      if (passes) {
        const auto [out, in] = out_and_in(node, segments_[at_node_[first_[node]]]);
        const auto [next_out, next_in] = out_and_in(node, segments_[at_node_[first_[node] + 1]]);
        passes = out == next_in && in == next_out;
      }
      if (!passes) add_junction(node);
    }
  }

  void add_junction(std::uint32_t node) {
    junction_[node] = static_cast<std::uint32_t>(data_.junctions.size());
    data_.junctions.push_back({map_.nodes[node].id, 0, 0});
  }

  void trace_from(std::uint32_t node) {
    for (std::uint32_t i = first_[node]; i < first_[node + 1]; ++i)
      if (!segments_[at_node_[i]].used) trace(node, at_node_[i]);
  }

  // Traces one link from a junction along its first segment to the next junction.
  void trace(std::uint32_t node, std::uint32_t segment) {
    Link link;
    link.first_vertex = static_cast<std::uint32_t>(data_.vertices.size());
    link.start_junction = junction_[node];
    std::tie(link.forward, link.backward) = out_and_in(node, segments_[segment]);
    double along = 0.0;
    bool along_way = true;
    const auto add_vertex = [&](std::uint32_t at, const Segment& s) {
      data_.vertices.push_back(
          {place_[at].x(), place_[at].y(), along, map_.nodes[at].id, s.road, along_way});
    };
    while (true) {
      Segment& s = segments_[segment];
      s.used = true;
      along_way = s.from == node;
      const std::uint32_t next = along_way ? s.to : s.from;
      add_vertex(node, s);
      along += std::max(min_segment, (place_[next] - place_[node]).norm());
      node = next;
      if (junction_[node] != none) {
        add_vertex(node, s);
        break;
      }
      segment =
          at_node_[first_[node]] == segment ? at_node_[first_[node] + 1] : at_node_[first_[node]];
    }
    link.vertex_count = static_cast<std::uint32_t>(data_.vertices.size()) - link.first_vertex;
    link.end_junction = junction_[node];
    link.length = along;
    data_.links.push_back(link);
  }

  void list_exits() {
    std::vector<std::vector<DirectedLink>> exits(data_.junctions.size());
    for (std::uint32_t i = 0; i < data_.links.size(); ++i) {
      exits[data_.links[i].start_junction].push_back({i, true});
      exits[data_.links[i].end_junction].push_back({i, false});
    }
    for (std::size_t j = 0; j < exits.size(); ++j) {
      data_.junctions[j].first_exit = static_cast<std::uint32_t>(data_.exits.size());
      data_.junctions[j].exit_count = static_cast<std::uint32_t>(exits[j].size());
      data_.exits.insert(data_.exits.end(), exits[j].begin(), exits[j].end());
    }
  }

  // Returns the way of a link's first segment as it leaves a junction.
  std::int64_t way_leaving(DirectedLink d) const {
    const Link& l = data_.links[d.link];
    const std::uint32_t vertex = d.forward ? l.first_vertex : l.first_vertex + l.vertex_count - 2;
    return data_.roads[data_.vertices[vertex].road].way_id;
  }

  void ban_turns() {
    std::map<std::int64_t, std::uint32_t> junction_of;
    for (std::uint32_t j = 0; j < data_.junctions.size(); ++j)
      junction_of[data_.junctions[j].node_id] = j;
    std::size_t unused = 0, crowded = 0;
    const auto order = [](const BannedTurn& a, const BannedTurn& b) {
      const auto key = [](const BannedTurn& t) {
        return std::tie(t.from.link, t.from.forward, t.to.link, t.to.forward);
      };
      return key(a) < key(b);
    };
    std::set<BannedTurn, decltype(order)> banned(
        order);  // several restrictions may ban the same turn
    for (const MapRestriction& r : map_.restrictions) {
      const auto junction = junction_of.find(r.via_node);
      bool used = false;
      if (junction != junction_of.end()) {
        const Junction& j = data_.junctions[junction->second];
        if (j.exit_count > input_limits::roads_at_node) {
          ++crowded;
          continue;
        }
        for (std::uint32_t i = j.first_exit; i < j.first_exit + j.exit_count; ++i) {
          if (way_leaving(data_.exits[i]) != r.from_way) continue;
          for (std::uint32_t k = j.first_exit; k < j.first_exit + j.exit_count; ++k) {
            const bool named = way_leaving(data_.exits[k]) == r.to_way;
            if (k == i || named == r.only) continue;
            banned.insert({data_.exits[i].reversed(), data_.exits[k]});
            used = true;
          }
        }
      }
      if (!used) ++unused;
    }
    data_.banned.assign(banned.begin(), banned.end());
    if (crowded > 0) {
      data_.warnings.push_back(std::to_string(crowded) + " turn restrictions are left out where " +
                               "more than " + std::to_string(input_limits::roads_at_node) +
                               " roads meet");
    }
    if (map_.restrictions_over_ways > 0) {
      data_.warnings.push_back(std::to_string(map_.restrictions_over_ways) +
                               " turn restrictions via a way are left out");
    }
    if (unused > 0) {
      data_.warnings.push_back(std::to_string(unused) +
                               " turn restrictions name roads that do not meet at their node");
    }
  }

  const MapExtract& map_;
  NetworkData data_;
  std::vector<Eigen::Vector2d> place_;  // by node
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> first_, at_node_;  // segments by node
  std::vector<std::uint32_t> junction_;         // index by node, or `none`
};

}  // namespace

NetworkData build_network(const MapExtract& map) {
  return Builder(map).build();
}

}  // namespace maploop::mapmatch
