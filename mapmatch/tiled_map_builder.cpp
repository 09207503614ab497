#include "mapmatch/tiled_map_builder.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <osmium/handler.hpp>
#include <osmium/io/any_input.hpp>
#include <osmium/visitor.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mapmatch/osm_objects.h"
#include "mapmatch/road_network.h"
#include "mapmatch/tiled_map_format.h"
#include "msgs/archive.h"

namespace maploop::mapmatch {
namespace {

constexpr std::size_t ids_at_once = 1 << 24;      // 128 MB
constexpr std::size_t nodes_in_memory = 1 << 22;  // of ways that wait to be written
constexpr std::int32_t longest_segment =
    20;  // tiles; a longer one is only in the tiles of its ends

// Holds the nodes of all roads: first their ids, then their places.
class RoadNodes {
 public:
  explicit RoadNodes(std::size_t max_nodes) : max_nodes_(max_nodes) {}

  void add(std::int64_t id) {
    added_.push_back(id);
    if (added_.size() == ids_at_once) merge();
  }
  // Ends the adding.
  void close() {
    merge();
    added_ = {};
    places_.resize(ids_.size());
  }

  // Files list nodes by their ids, so the next one is near the last.
  void place(std::int64_t id, const osmium::Location& location) {
    if (next_ == ids_.size() || id < ids_[next_]) next_ = index(id, 0, ids_.size());
    for (int i = 0; i < few && next_ < ids_.size() && ids_[next_] < id; ++i) ++next_;
    if (next_ < ids_.size() && ids_[next_] < id) next_ = index(id, next_, ids_.size());
    if (next_ < ids_.size() && ids_[next_] == id) places_[next_] = {location.y(), location.x()};
  }

  TiledNode node(std::int64_t id) const {
    const std::size_t i = index(id, 0, ids_.size());
    const bool known = i < ids_.size() && ids_[i] == id;
    return known ? TiledNode{id, places_[i].latitude, places_[i].longitude} : TiledNode{id};
  }

  std::size_t size() const { return ids_.size(); }

 private:
  static constexpr int few = 16;  // steps that cost less than a search

  struct Place {
    std::int32_t latitude = TiledNode::nowhere, longitude = 0;
  };

  std::size_t index(std::int64_t id, std::size_t low, std::size_t high) const {
    const auto begin = ids_.begin();
    return static_cast<std::size_t>(std::lower_bound(begin + static_cast<std::ptrdiff_t>(low),
                                                     begin + static_cast<std::ptrdiff_t>(high),
                                                     id) -
                                    begin);
  }

  void merge() {
    std::sort(added_.begin(), added_.end());
    added_.erase(std::unique(added_.begin(), added_.end()), added_.end());
    std::vector<std::int64_t> all;
    all.reserve(ids_.size() + added_.size());
    std::set_union(ids_.begin(), ids_.end(), added_.begin(), added_.end(), std::back_inserter(all));
    ids_ = std::move(all);
    added_.clear();
    if (ids_.size() > max_nodes_) {
      throw std::runtime_error("its roads have more than " + std::to_string(max_nodes_) +
                               " nodes; select a part of it with a box");
    }
  }

  std::size_t max_nodes_;
  std::vector<std::int64_t> ids_, added_;  // ids_: sorted, each once
  std::vector<Place> places_;              // of ids_
  std::size_t next_ = 0;                   // in ids_, of the node after the last one placed
};

// Removes a file at the end.
class Scratch {
 public:
  explicit Scratch(std::filesystem::path file) : file_(std::move(file)) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

std::runtime_error cannot_write(const std::filesystem::path& file) {
  return std::runtime_error("cannot write " + file.string() +
                            ": check that its folder exists and that the disk has room");
}

Bytes sealed(const auto& value) {
  ArchiveWriter writer;
  writer(value);
  return seal(writer.content());
}

// Collects the ways and restrictions of every tile. What exceeds the memory waits in a file.
class TileCollector {
 public:
  explicit TileCollector(const std::filesystem::path& waiting)
      : scratch_(waiting),
        waiting_(waiting, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc) {
    if (!waiting_) throw cannot_write(waiting);
  }

  void add(const TiledWay& way) {
    std::set<TilePlace> places;
    const TiledNode* last = nullptr;
    for (const TiledNode& node : way.nodes) {
      if (node.latitude != TiledNode::nowhere) {
        cross(last != nullptr ? *last : node, node, places);
        last = &node;
      } else {
        last = nullptr;
      }
    }
    for (const TilePlace& place : places) tiles_[place].content.ways.push_back(way);
    in_memory_ += way.nodes.size() * places.size();
    if (in_memory_ > nodes_in_memory) put_away();
  }

  void add(const MapRestriction& restriction, const TiledNode& via) {
    tiles_[place_of(via)].content.restrictions.push_back(restriction);
  }

  std::size_t size() const { return tiles_.size(); }

  // Writes the whole file; `table` holds what is known of all tiles.
  void write(const std::filesystem::path& result, TileTable table) {
    put_away();
    waiting_.flush();
    require_written();
    std::ofstream out(result, std::ios::binary);
    std::uint64_t offset = 0;
    const auto append = [&](const Bytes& bytes) {
      out.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
      offset += bytes.size();
      if (!out) throw cannot_write(result);
    };
    append(sealed(TiledMapHead{}));
    for (const auto& [place, collected] : tiles_) {
      const Tile tile = brought_back(place, collected);
      count_carriageways(tile, table);
      const Bytes bytes = sealed(tile);
      table.tiles.push_back({place, offset, bytes.size()});
      append(bytes);
    }
    const TiledMapHead head{offset, sealed(table).size()};
    append(sealed(table));
    out.seekp(0);
    append(sealed(head));
    out.flush();
    if (!out) throw cannot_write(result);
  }

 private:
  struct Piece {
    std::uint64_t offset = 0, size = 0;  // bytes in the waiting file
  };
  struct Collected {
    Tile content;
    std::vector<Piece> pieces;
  };

  static TilePlace place_of(const TiledNode& node) {
    return tile_at(node.latitude / TiledNode::per_degree, node.longitude / TiledNode::per_degree);
  }

  // Adds all tiles of the box around two nodes. Those of a segment that is too long or crosses the
  // 180th meridian are the ones of its ends.
  static void cross(const TiledNode& from, const TiledNode& to, std::set<TilePlace>& places) {
    const TilePlace a = place_of(from), b = place_of(to);
    places.insert(a);
    places.insert(b);
    if (std::abs(a.row - b.row) > longest_segment ||
        std::abs(a.column - b.column) > longest_segment)
      return;
    for (std::int32_t row = std::min(a.row, b.row); row <= std::max(a.row, b.row); ++row) {
      for (std::int32_t column = std::min(a.column, b.column);
           column <= std::max(a.column, b.column); ++column)
        places.insert({row, column});
    }
  }

  static void count_carriageways(const Tile& tile, TileTable& table) {
    MapExtract map;
    mapmatch::append(map, tile);
    sort_once(map);
    const RoadNetwork network(build_network(map));
    table.to_left += network.one_way_checks().to_left;
    table.to_right += network.one_way_checks().to_right;
  }

  void require_written() const {
    if (!waiting_) throw cannot_write(scratch_.file());
  }

  void put_away() {
    for (auto& [place, tile] : tiles_) {
      if (tile.content.ways.empty() && tile.content.restrictions.empty()) continue;
      ArchiveWriter writer;
      writer(tile.content);
      tile.content = {};
      tile.pieces.push_back({end_, writer.content().size()});
      end_ += writer.content().size();
      waiting_.write(reinterpret_cast<const char*>(writer.content().data()),
                     static_cast<std::streamsize>(writer.content().size()));
      require_written();
    }
    in_memory_ = 0;
  }

  Tile brought_back(const TilePlace& place, const Collected& tile) {
    Tile whole;
    whole.place = place;
    for (const Piece& piece : tile.pieces) {
      Bytes bytes(piece.size);
      waiting_.seekg(static_cast<std::streamoff>(piece.offset));
      waiting_.read(reinterpret_cast<char*>(bytes.data()),
                    static_cast<std::streamsize>(bytes.size()));
      if (!waiting_) throw std::runtime_error("cannot read " + scratch_.file().string() + " back");
      Tile part;
      ArchiveReader reader(bytes);
      reader(part);
      reader.finish();
      std::move(part.ways.begin(), part.ways.end(), std::back_inserter(whole.ways));
      whole.restrictions.insert(whole.restrictions.end(), part.restrictions.begin(),
                                part.restrictions.end());
    }
    return whole;
  }

  Scratch scratch_;
  std::fstream waiting_;
  std::uint64_t end_ = 0;  // bytes in the waiting file
  std::map<TilePlace, Collected> tiles_;
  std::size_t in_memory_ = 0;  // nodes
};

using bits = osmium::osm_entity_bits::type;

template <class Visit>
void each(const osmium::io::File& file, bits kinds, Visit visit) {
  osmium::io::Reader reader(file, kinds);
  while (const osmium::memory::Buffer buffer = reader.read())
    for (const auto& object : buffer.select<osmium::OSMObject>()) visit(object);
  reader.close();
}

}  // namespace

TiledMapSummary build_tiled_map(const std::filesystem::path& map,
                                const std::filesystem::path& result, const OsmOptions& options,
                                const std::function<void(const std::string& step)>& progress) {
  TiledMapSummary summary;
  const Scratch unfinished(result.string() + ".unfinished");
  TileCollector tiles(result.string() + ".waiting");
  TileTable table;
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
             tiles.add(found->restriction, via);
             ++summary.restrictions;
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
           tiles.add(tiled);
           ++summary.ways;
           summary.missing_nodes += missing;
         });
    summary.nodes = nodes.size();
    summary.tiles = tiles.size();
    if (summary.ways == 0)
      throw std::runtime_error(options.box ? "it has no roads inside the box" : "it has no roads");
  });
  progress("writing the tiles");
  table.ways = summary.ways;
  table.nodes = summary.nodes;
  table.restrictions = summary.restrictions;
  tiles.write(unfinished.file(), std::move(table));
  std::filesystem::rename(unfinished.file(), result);
  return summary;
}

}  // namespace maploop::mapmatch
