// Small OpenStreetMap files, and what tests ask of the roads read from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mapmatch/geographic_box.h"
#include "mapmatch/network_builder.h"

namespace maploop::testing {

// An OpenStreetMap file of nodes, each at "LAT LON", and of residential roads through them.
class OsmFile {
 public:
  explicit OsmFile(const std::filesystem::path& folder) : file_(folder / "small.osm") {}

  OsmFile& node(std::int64_t id, double latitude, double longitude) {
    nodes_ += "<node id=\"" + std::to_string(id) + "\" lat=\"" + std::to_string(latitude) +
              "\" lon=\"" + std::to_string(longitude) + "\"/>";
    return *this;
  }
  OsmFile& road(std::int64_t id, const std::vector<std::int64_t>& nodes) {
    ways_ += "<way id=\"" + std::to_string(id) + "\">";
    for (const std::int64_t n : nodes) ways_ += "<nd ref=\"" + std::to_string(n) + "\"/>";
    ways_ += "<tag k=\"highway\" v=\"residential\"/></way>";
    return *this;
  }
  OsmFile& ban(std::int64_t from, std::int64_t via, std::int64_t to) {
    const auto member = [](const char* type, std::int64_t ref, const char* role) {
      return std::string("<member type=\"") + type + "\" ref=\"" + std::to_string(ref) +
             "\" role=\"" + role + "\"/>";
    };
    relations_ += "<relation id=\"1\">" + member("way", from, "from") + member("node", via, "via") +
                  member("way", to, "to") +
                  "<tag k=\"type\" v=\"restriction\"/>"
                  "<tag k=\"restriction\" v=\"no_left_turn\"/></relation>";
    return *this;
  }
  const std::filesystem::path& write() const {
    std::ofstream(file_) << "<osm version=\"0.6\">" << nodes_ << ways_ << relations_ << "</osm>";
    return file_;
  }

 private:
  std::filesystem::path file_;
  std::string nodes_, ways_, relations_;
};

// Nodes 1 to 5 lie in three tiles of a tiled map; road 11, from node 2 on, is still to come.
inline OsmFile three_tiles(const std::filesystem::path& folder) {
  return OsmFile(folder)
      .node(1, 49.01, 8.41)
      .node(2, 49.02, 8.42)
      .node(3, 49.02, 8.47)
      .node(4, 49.11, 8.41)
      .node(5, 49.12, 8.41)
      .road(10, {1, 2})
      .road(12, {4, 5})
      .ban(10, 2, 11)
      .ban(12, 4, 12);
}

inline std::vector<std::int64_t> ways_of(const mapmatch::MapExtract& map) {
  std::vector<std::int64_t> ways;
  for (const mapmatch::MapWay& way : map.ways) ways.push_back(way.road.way_id);
  return ways;
}

inline mapmatch::GeographicBox at_place(double latitude, double longitude) {
  return {longitude, latitude, longitude, latitude};
}

}  // namespace maploop::testing
