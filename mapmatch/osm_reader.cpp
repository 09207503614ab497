#include "mapmatch/osm_reader.h"

#include <algorithm>
#include <osmium/handler.hpp>
#include <osmium/io/any_input.hpp>
#include <osmium/osm.hpp>
#include <osmium/visitor.hpp>
#include <stdexcept>
#include <string>

#include "mapmatch/osm_tags.h"

namespace maploop::mapmatch {
namespace {

constexpr double not_placed = 1000.0;  // degrees

bool inside(const GeographicBox& box, const osmium::Location& l) {
  return l.lon() >= box.west && l.lon() <= box.east && l.lat() >= box.south && l.lat() <= box.north;
}

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
  if (nodes.size() > options.max_nodes)
    throw std::runtime_error("more than " + std::to_string(options.max_nodes) +
                             " nodes; select a part of it with a box");
}

// libosmium finds the end of each key and value by its zero byte. A zero byte inside a string would
// make it read past the end of the list.
template <class Object>
const osmium::TagList& sound_tags(const Object& object) {
  const osmium::TagList& tags = object.tags();
  const unsigned char* const begin = tags.data() + sizeof tags;
  const unsigned char* const end = tags.data() + tags.byte_size();
  if (std::count(begin, end, '\0') % 2 != 0 || (begin != end && end[-1] != '\0')) {
    throw std::runtime_error("a tag of " + std::string(osmium::item_type_to_name(object.type())) +
                             " " + std::to_string(object.id()) +
                             " has a zero byte inside: the file is damaged, download it again");
  }
  return tags;
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
    const osmium::TagList& tags = sound_tags(w);
    const auto road = road_from_tags(
        w.id(), [&](const char* key) { return std::string_view(tags.get_value_by_key(key, "")); });
    if (!road) return;
    MapWay way{*road, {}};
    for (const osmium::NodeRef& n : w.nodes()) way.nodes.push_back(n.ref());
    if (options_.box) {
      if (std::none_of(way.nodes.begin(), way.nodes.end(),
                       [&](std::int64_t id) { return find(map_.nodes, id) != nullptr; }))
        return;
    } else {
      for (const std::int64_t id : way.nodes) map_.nodes.push_back({id, not_placed, 0.0});
      if (map_.nodes.size() > options_.max_nodes) sort_once(map_.nodes);
      require_room(map_.nodes, options_);
    }
    map_.ways.push_back(std::move(way));
  }

  void relation(const osmium::Relation& r) {
    const osmium::TagList& tags = sound_tags(r);
    if (!tags.has_tag("type", "restriction")) return;
    const std::string_view except = tags.get_value_by_key("except", "");
    for (const char* car : {"motorcar", "motor_vehicle"})
      if (except.find(car) != std::string_view::npos) return;
    const char* told = "";  // the most specific key has priority
    for (const char* key : {"restriction", "restriction:motor_vehicle", "restriction:motorcar"})
      told = tags.get_value_by_key(key, told);
    const std::string_view kind = told;
    MapRestriction restriction;
    bool over_a_way = false;
    restriction.only = kind.starts_with("only_");
    if (!restriction.only && !kind.starts_with("no_")) return;
    for (const osmium::RelationMember& m : r.members()) {
      const std::string_view role = m.role();
      if (role == "from" && m.type() == osmium::item_type::way) restriction.from_way = m.ref();
      if (role == "to" && m.type() == osmium::item_type::way) restriction.to_way = m.ref();
      if (role == "via" && m.type() == osmium::item_type::node) restriction.via_node = m.ref();
      over_a_way = over_a_way || (role == "via" && m.type() == osmium::item_type::way);
    }
    map_.restrictions_over_ways += over_a_way ? 1 : 0;
    if (restriction.from_way != 0 && restriction.to_way != 0 && restriction.via_node != 0)
      map_.restrictions.push_back(restriction);
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
  const auto fail = [&](const std::string& what) {
    return std::runtime_error("cannot read the map " + file.string() + ": " + what);
  };
  if (!std::filesystem::exists(file)) throw fail("there is no such file");
  if (!std::filesystem::is_regular_file(file)) throw fail("it is not a regular file");
  if (std::filesystem::file_size(file) == 0) throw fail("it is empty");
  MapExtract map;
  try {
    map = read(osmium::io::File(file.string()), options);
  } catch (const std::bad_alloc&) {
    throw fail("it does not fit into memory; select a part of it with a box");
  } catch (const std::exception& e) {
    throw fail(std::string(e.what()) + " (expected: .osm.pbf, .osm, .osm.gz or .osm.bz2)");
  }
  if (map.ways.empty() || map.nodes.empty())
    throw fail(options.box ? "it has no roads inside the box" : "it has no roads");
  return map;
}

}  // namespace maploop::mapmatch
