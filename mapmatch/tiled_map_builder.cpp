#include "mapmatch/tiled_map_builder.h"

#include <cstddef>
#include <filesystem>
#include <osmium/io/any_input.hpp>
#include <stdexcept>

#include "mapmatch/corrected_roads.h"
#include "mapmatch/osm_objects.h"
#include "mapmatch/road_nodes.h"
#include "mapmatch/tile_collector.h"

namespace maploop::mapmatch {
namespace {

using bits = osmium::osm_entity_bits::type;

template <class Visit>
void each(const osmium::io::File& file, bits kinds, Visit visit) {
  osmium::io::Reader reader(file, kinds);
  while (const osmium::memory::Buffer buffer = reader.read())
    for (const auto& object : buffer.select<osmium::OSMObject>()) visit(object);
  reader.close();
}

// Returns the file behind links, which stay. Devices and pipes are not replaced by a file.
std::filesystem::path replaceable(const std::filesystem::path& file) {
  std::filesystem::path target = std::filesystem::weakly_canonical(file);
  if (std::filesystem::exists(target) && !std::filesystem::is_regular_file(target)) {
    throw std::runtime_error("cannot write the tiled map " + file.string() +
                             ": it is not a regular file; give another name");
  }
  return target;
}

}  // namespace

BuiltTiles build_tiled_map(const std::filesystem::path& map, const std::filesystem::path& given,
                           const OsmOptions& options,
                           const std::function<void(const std::string& step)>& progress,
                           const MapCorrection& correction) {
  const std::filesystem::path result = replaceable(given);
  BuiltTiles built;
  TileTable& table = built.table;
  TileCollector tiles(result.string() + ".waiting");
  CorrectedRoads corrected(correction);
  read_map_file(map, [&](const osmium::io::File& file) {
    RoadNodes nodes(options.max_nodes);
    progress("which nodes roads have");
    each(file, osmium::osm_entity_bits::way, [&](const osmium::OSMObject& object) {
      if (const auto way = road_of(static_cast<const osmium::Way&>(object)))
        for (const std::int64_t id : way->nodes) nodes.add(id);
    });
    nodes.close();
    progress("where these nodes are");
    each(file, osmium::osm_entity_bits::node, [&](const osmium::OSMObject& object) {
      const osmium::Location location = static_cast<const osmium::Node&>(object).location();
      if (location.valid() && inside(options.box.value_or(GeographicBox{}), location))
        nodes.place(object.id(), location);
    });
    progress("which tiles roads are in");
    each(file, osmium::osm_entity_bits::way | osmium::osm_entity_bits::relation,
         [&](const osmium::OSMObject& object) {
           if (object.type() == osmium::item_type::relation) {
             const auto found = restriction_of(static_cast<const osmium::Relation&>(object));
             if (!found) return;
             table.restrictions_over_ways += found->over_a_way ? 1 : 0;
             if (!found->usable()) return;
             const TiledNode via = nodes.node(found->restriction.via_node);
             if (via.latitude == TiledNode::nowhere) return;
             if (corrected.keep(found->restriction, via)) return;
             tiles.add(found->restriction, via);
             ++table.restrictions;
             return;
           }
           const auto way = road_of(static_cast<const osmium::Way&>(object));
           if (!way) return;
           TiledWay tiled{way->road, {}};
           std::size_t missing = 0;
           for (const std::int64_t id : way->nodes) {
             tiled.nodes.push_back(nodes.node(id));
             missing += tiled.nodes.back().latitude == TiledNode::nowhere ? 1 : 0;
           }
           if (missing == tiled.nodes.size()) return;
           built.missing_nodes += missing;
           if (corrected.keep(tiled)) return;
           tiles.add(tiled);
           ++table.ways;
         });
    table.nodes = nodes.size();
    corrected.give(tiles, table);
    if (table.ways == 0)
      throw std::runtime_error(options.box ? "it has no roads inside the box" : "it has no roads");
  });
  progress("writing the tiles");
  tiles.write(result, table);
  return built;
}

}  // namespace maploop::mapmatch
