// A road network consists of links from junction to junction, with their shape in local metres.
//
// A junction is a node where roads meet or end, or where the permitted directions change. A node
// where one way simply continues as another is not a junction, so a link can consist of several
// roads. A network is immutable after construction: any number of threads may read it at the same
// time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mapmatch/one_way_check.h"
#include "mapmatch/road.h"
#include "mapmatch/segment_index.h"
#include "msgs/local_frame.h"
#include "msgs/map_match.h"
#include "msgs/road_side.h"

namespace maploop::mapmatch {

// This is a node of a link's shape.
struct Vertex {
  double east = 0.0, north = 0.0;  // m, in the network's frame
  double along = 0.0;              // m from the link's first vertex
  std::int64_t node_id = 0;        // OpenStreetMap's
  std::uint32_t road =
      0;                  // of the segment that starts here; the last vertex repeats the one before
  bool along_way = true;  // whether the way has the segment's nodes in the order of the link

  // Returns east and north in m.
  Eigen::Vector2d position() const { return {east, north}; }
};

template <class Archive>
void archive(Archive& ar, Vertex& v) {
  ar(v.east, v.north, v.along, v.node_id, v.road, v.along_way);
}

// A Link is the way from one junction to the next, in one or both directions.
struct Link {
  std::uint32_t first_vertex = 0;    // index in NetworkData::vertices; the others follow
  std::uint32_t vertex_count = 0;    // at least 2
  std::uint32_t start_junction = 0;  // of its first vertex
  std::uint32_t end_junction = 0;    // of its last vertex
  bool forward = true;               // may be driven from its first vertex to its last
  bool backward = true;              // may be driven from its last vertex to its first
  double length = 0.0;               // m

  // Returns whether it may be driven in one direction only.
  bool one_way() const { return forward != backward; }
};

template <class Archive>
void archive(Archive& ar, Link& l) {
  ar(l.first_vertex, l.vertex_count, l.start_junction, l.end_junction, l.forward, l.backward,
     l.length);
}

using maploop::DirectedLink;

// A junction refers to its exits in NetworkData::exits.
struct Junction {
  std::int64_t node_id = 0;      // OpenStreetMap's
  std::uint32_t first_exit = 0;  // index in NetworkData::exits; the others follow
  std::uint32_t exit_count = 0;  // links that start or end here, including forbidden directions
};

template <class Archive>
void archive(Archive& ar, Junction& j) {
  ar(j.node_id, j.first_exit, j.exit_count);
}

// The turn from `from` to `to` is forbidden.
struct BannedTurn {
  DirectedLink from, to;  // driven before and after the junction
};

template <class Archive>
void archive(Archive& ar, BannedTurn& b) {
  ar(b.from, b.to);
}

// This is a place on a directed link.
struct LinkPoint {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();    // m, east and north
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // unit, as driven
  std::uint32_t vertex = 0;  // index in the network of its segment's first stored vertex

  double azimuth() const;  // rad
};

// Holds the content of a network file; everything else is computed from it.
struct NetworkData {
  Geodetic origin;          // of the local frame; its height is 0, as is that of all map positions
  std::vector<Road> roads;  // Vertex::road is an index here
  std::vector<Vertex> vertices;       // link by link, in the order of its shape
  std::vector<Link> links;            // DirectedLink::link is an index here
  std::vector<Junction> junctions;    // Link::start_junction and end_junction are indices here
  std::vector<DirectedLink> exits;    // by junction
  std::vector<BannedTurn> banned;     // sorted by `from`
  std::vector<std::string> warnings;  // notes on the map such as omitted content, one sentence each
};

template <class Archive>
void archive(Archive& ar, NetworkData& d) {
  ar(d.origin, d.roads, d.vertices, d.links, d.junctions, d.exits, d.banned, d.warnings);
}

// A RoadNetwork answers questions about its data. Its functions do not check the indices of links,
// vertices and junctions that they are given: these must exist.
class RoadNetwork {
 public:
  // Throws std::invalid_argument if the data are inconsistent (an index out of range, a link
  // without length, positions that are not finite).
  explicit RoadNetwork(NetworkData data, RoadSide traffic = RoadSide::by_map);

  // Returns what the network was built from.
  const NetworkData& data() const { return data_; }
  // Returns the frame of local metres, whose origin is that of the data.
  const LocalFrame& frame() const { return frame_; }
  // Returns the index by which segments are found near a place.
  const SegmentIndex& index() const { return index_; }

  // Returns east and north (m) of a place; its height is ignored.
  Eigen::Vector2d to_local(const Geodetic& place) const;
  // Returns the place at height 0 that has this east and north (m).
  Geodetic to_geodetic(const Eigen::Vector2d& place) const;

  // Returns the number of links.
  std::size_t size() const { return data_.links.size(); }
  // Returns a link by its index, which is below size().
  const Link& link(std::uint32_t i) const { return data_.links[i]; }
  // Returns a vertex by its index in NetworkData::vertices.
  const Vertex& vertex(std::uint32_t i) const { return data_.vertices[i]; }
  // Returns the road of the segment that starts at a vertex.
  const Road& road_at(std::uint32_t vertex) const {
    return data_.roads[data_.vertices[vertex].road];
  }
  // Returns all vertices of a link, in the order in which they are stored.
  std::span<const Vertex> shape(std::uint32_t link) const {
    return {data_.vertices.data() + data_.links[link].first_vertex, data_.links[link].vertex_count};
  }

  // Returns whether the map allows driving in this direction.
  bool allowed(DirectedLink d) const {
    return d.forward ? link(d.link).forward : link(d.link).backward;
  }
  // Returns what the map shows of the directions of its one-way links.
  const OneWayChecks& one_way_checks() const { return one_way_checks_; }
  // Returns whether traffic keeps to the left.
  bool left_hand_traffic() const { return left_hand_traffic_; }
  // Returns whether the map contradicts the direction of a one-way link.
  bool doubted(std::uint32_t link) const {
    return one_way_checks_.of_link[link].contradicts(left_hand_traffic_);
  }
  // Returns whether no restriction of the map bans this turn. It does not matter whether the links
  // meet, or may be driven in this direction.
  bool allowed_turn(DirectedLink from, DirectedLink to) const;
  // Returns the junction to which a directed link leads, as an index in NetworkData::junctions.
  std::uint32_t end_junction(DirectedLink d) const {
    return d.forward ? link(d.link).end_junction : link(d.link).start_junction;
  }
  // Returns the junction from which a directed link comes.
  std::uint32_t start_junction(DirectedLink d) const { return end_junction(d.reversed()); }
  // Returns the links that leave a junction, including those against one-way streets.
  std::span<const DirectedLink> exits(std::uint32_t junction) const {
    const Junction& j = data_.junctions[junction];
    return {data_.exits.data() + j.first_exit, j.exit_count};
  }

  // Returns the place s metres along a directed link from where it is entered. Outside the link,
  // the place is on the straight continuation of its first or last segment.
  LinkPoint at(DirectedLink d, double s) const;
  // Returns the nodes of the OSM segment of a place, in driving direction.
  std::pair<std::int64_t, std::int64_t> nodes(DirectedLink d, std::uint32_t vertex) const;

 private:
  void check() const;

  NetworkData data_;
  LocalFrame frame_;
  SegmentIndex index_;
  OneWayChecks one_way_checks_;
  bool left_hand_traffic_ = false;
};

}  // namespace maploop::mapmatch
