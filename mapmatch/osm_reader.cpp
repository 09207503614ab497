#include "mapmatch/osm_reader.h"

#include <algorithm>
#include <osmium/handler.hpp>
#include <osmium/io/any_input.hpp>
#include <osmium/osm.hpp>
#include <osmium/visitor.hpp>
#include <stdexcept>
#include <string>

#include "mapmatch/osm_objects.h"

namespace maploop::mapmatch {
namespace {

constexpr double not_placed = 1000.0;  // degrees

bool by_id(const MapNode& a, const MapNode& b) {
  return a.id < b.id;
}

MapNode* find(std::vector<MapNode>& nodes, std::int64_t id) {
  const auto found = std::lower_bound(nodes.begin(), nodes.end(), MapNode{id, 0.0, 0.0}, by_id);
  return found != nodes.end() && found->id == id ? &*found : nullptr;
}

void sort_once(std::vector<MapNode>& nodes) {
  std::sort(nodes.begin(), nodes.end(), by_id);
  nodes.erase(std::unique(nodes.begin(), nodes.end(),
                          [](const MapNode& a, const MapNode& b) { return a.id == b.id; }),
              nodes.end());
}

void require_room(const std::vector<MapNode>& nodes, const OsmOptions& options) {
  if (nodes.size() > options.max_nodes) {
    throw std::runtime_error("more than " + std::to_string(options.max_nodes) +
                             " nodes; select a part of it with a box");
  }
}

// Collects the nodes inside the box.
class NodesInside : public osmium::handler::Handler {
 public:
  NodesInside(MapExtract& map, const OsmOptions& options) : map_(map), options_(options) {}
  void node(const osmium::Node& n) {
    if (!n.location().valid() || !inside(*options_.box, n.location())) return;
    map_.nodes.push_back({n.id(), n.location().lat(), n.location().lon()});
    require_room(map_.nodes, options_);
  }

 private:
  MapExtract& map_;
  const OsmOptions& options_;
};

// Collects drivable ways (with a box, those that touch it) and turn restrictions.
class Roads : public osmium::handler::Handler {
 public:
  Roads(MapExtract& map, const OsmOptions& options) : map_(map), options_(options) {}

  void way(const osmium::Way& w) {
    std::optional<MapWay> road = road_of(w);
    if (!road) return;
    if (options_.box) {
      if (std::none_of(road->nodes.begin(), road->nodes.end(),
                       [&](std::int64_t id) { return find(map_.nodes, id) != nullptr; }))
        return;
    } else {
      for (const std::int64_t id : road->nodes) map_.nodes.push_back({id, not_placed, 0.0});
      if (map_.nodes.size() > options_.max_nodes) sort_once(map_.nodes);
      require_room(map_.nodes, options_);
    }
    map_.ways.push_back(std::move(*road));
  }

  void relation(const osmium::Relation& r) {
    const auto found = restriction_of(r);
    if (!found) return;
    map_.restrictions_over_ways += found->over_a_way ? 1 : 0;
    if (found->usable()) map_.restrictions.push_back(found->restriction);
  }

 private:
  MapExtract& map_;
  const OsmOptions& options_;
};

// Fills in the positions of the nodes of the roads.
class Places : public osmium::handler::Handler {
 public:
  explicit Places(MapExtract& map) : map_(map) {}
  void node(const osmium::Node& n) {
    if (!n.location().valid()) return;
    if (MapNode* place = find(map_.nodes, n.id())) {
      place->latitude = n.location().lat();
      place->longitude = n.location().lon();
    }
  }

 private:
  MapExtract& map_;
};

template <class Handler>
void pass(const osmium::io::File& file, osmium::osm_entity_bits::type kinds, Handler handler) {
  osmium::io::Reader reader(file, kinds);
  osmium::apply(reader, handler);
  reader.close();
}

// Removes nodes that no road uses, and those without a position in the file.
void drop_unused(MapExtract& map) {
  std::vector<std::int64_t> used;
  for (const MapWay& way : map.ways) used.insert(used.end(), way.nodes.begin(), way.nodes.end());
  std::sort(used.begin(), used.end());
  std::erase_if(map.nodes, [&](const MapNode& n) {
    return n.latitude == not_placed || !std::binary_search(used.begin(), used.end(), n.id);
  });
}

MapExtract read(const osmium::io::File& file, const OsmOptions& options) {
  using bits = osmium::osm_entity_bits::type;
  constexpr bits node = osmium::osm_entity_bits::node;
  constexpr bits rest = osmium::osm_entity_bits::way | osmium::osm_entity_bits::relation;
  MapExtract map;
  if (options.box) {
    pass(file, node, NodesInside(map, options));
    sort_once(map.nodes);
    pass(file, rest, Roads(map, options));
  } else {
    pass(file, rest, Roads(map, options));
    sort_once(map.nodes);
    pass(file, node, Places(map));
  }
  drop_unused(map);
  return map;
}

}  // namespace

MapExtract read_osm(const std::filesystem::path& file, const OsmOptions& options) {
  MapExtract map;
  read_map_file(file, [&](const osmium::io::File& opened) { map = read(opened, options); });
  if (map.ways.empty() || map.nodes.empty()) {
    throw std::runtime_error(
        "cannot read the map " + file.string() +
        (options.box ? ": it has no roads inside the box" : ": it has no roads"));
  }
  return map;
}

}  // namespace maploop::mapmatch
