// OpenStreetMap files are opened here, and roads and turn restrictions recognized among their
// objects.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <osmium/io/file.hpp>
#include <osmium/osm/location.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>

#include "mapmatch/geographic_box.h"
#include "mapmatch/network_builder.h"

namespace maploop::mapmatch {

// Calls `read` with the file. Throws std::runtime_error, which names the file and the remedy, if it
// is missing, not a map or damaged, or if `read` throws.
void read_map_file(const std::filesystem::path& file,
                   const std::function<void(const osmium::io::File&)>& read);

// Returns whether a place is in the box.
bool inside(const GeographicBox& box, const osmium::Location& place);

// Returns the road with the ids of all its nodes, or nothing if cars cannot drive on this way.
// Throws std::runtime_error if a tag is damaged.
std::optional<MapWay> road_of(const osmium::Way& way);

// A restriction is usable if it is over a node.
struct RestrictionOfCars {
  MapRestriction restriction;
  bool over_a_way = false;

  bool usable() const {
    return restriction.from_way != 0 && restriction.to_way != 0 && restriction.via_node != 0;
  }
};
// Returns the restriction for cars, or nothing if the relation is none. Throws std::runtime_error
// if a tag is damaged.
std::optional<RestrictionOfCars> restriction_of(const osmium::Relation& relation);

}  // namespace maploop::mapmatch
