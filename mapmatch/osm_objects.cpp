#include "mapmatch/osm_objects.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

#include "mapmatch/network_file.h"
#include "mapmatch/osm_tags.h"
#include "mapmatch/tiled_map.h"

namespace maploop::mapmatch {
namespace {

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

}  // namespace

void read_map_file(const std::filesystem::path& file,
                   const std::function<void(const osmium::io::File&)>& read) {
  const auto fail = [&](const std::string& what) {
    return std::runtime_error("cannot read the map " + file.string() + ": " + what);
  };
  if (!std::filesystem::exists(file)) throw fail("there is no such file");
  if (!std::filesystem::is_regular_file(file)) throw fail("it is not a regular file");
  if (std::filesystem::file_size(file) == 0) throw fail("it is empty");
  if (is_network_file(file) || is_tiled_map(file))
    throw fail("it was made by 'maploop map build'; give the map that it was made from");
  try {
    read(osmium::io::File(file.string()));
  } catch (const std::bad_alloc&) {
    throw fail("it does not fit into memory; select a part of it with a box");
  } catch (const std::exception& e) {
    throw fail(std::string(e.what()) + " (expected: .osm.pbf, .osm, .osm.gz or .osm.bz2)");
  }
}

bool inside(const GeographicBox& box, const osmium::Location& place) {
  return place.lon() >= box.west && place.lon() <= box.east && place.lat() >= box.south &&
         place.lat() <= box.north;
}

std::optional<MapWay> road_of(const osmium::Way& way) {
  const osmium::TagList& tags = sound_tags(way);
  const auto road = road_from_tags(
      way.id(), [&](const char* key) { return std::string_view(tags.get_value_by_key(key, "")); });
  if (!road) return std::nullopt;
  MapWay found{*road, {}};
  for (const osmium::NodeRef& n : way.nodes()) found.nodes.push_back(n.ref());
  return found;
}

std::optional<RestrictionOfCars> restriction_of(const osmium::Relation& relation) {
  const osmium::TagList& tags = sound_tags(relation);
  if (!tags.has_tag("type", "restriction")) return std::nullopt;
  const std::string_view except = tags.get_value_by_key("except", "");
  for (const char* car : {"motorcar", "motor_vehicle"})
    if (except.find(car) != std::string_view::npos) return std::nullopt;
  const char* told = "";  // the most specific key has priority
  for (const char* key : {"restriction", "restriction:motor_vehicle", "restriction:motorcar"})
    told = tags.get_value_by_key(key, told);
  const std::string_view kind = told;
  RestrictionOfCars found;
  MapRestriction& restriction = found.restriction;
  restriction.only = kind.starts_with("only_");
  if (!restriction.only && !kind.starts_with("no_")) return std::nullopt;
  for (const osmium::RelationMember& m : relation.members()) {
    const std::string_view role = m.role();
    if (role == "from" && m.type() == osmium::item_type::way) restriction.from_way = m.ref();
    if (role == "to" && m.type() == osmium::item_type::way) restriction.to_way = m.ref();
    if (role == "via" && m.type() == osmium::item_type::node) restriction.via_node = m.ref();
    found.over_a_way = found.over_a_way || (role == "via" && m.type() == osmium::item_type::way);
  }
  return found;
}

}  // namespace maploop::mapmatch
