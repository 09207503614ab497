// The roads of a whole map are sorted by tiles here, in little memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "mapmatch/road_network.h"
#include "mapmatch/tiled_map.h"
#include "msgs/archive.h"
#include "msgs/whole_file.h"

namespace maploop::mapmatch {

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

inline std::runtime_error cannot_write(const std::filesystem::path& file) {
  return std::runtime_error("cannot write " + file.string() +
                            ": check that its folder exists and that the disk has room");
}

// Collects the ways and restrictions of every tile. What exceeds the memory waits in a file.
class TileCollector {
 public:
  explicit TileCollector(const std::filesystem::path& waiting)
      : scratch_(waiting),
        waiting_(waiting, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc) {
    if (!waiting_) throw cannot_write(waiting);
  }

  static TilePlace place_of(const TiledNode& node) {
    return tile_at(node.latitude / TiledNode::per_degree, node.longitude / TiledNode::per_degree);
  }

  // Returns the tiles that the way is in.
  static std::set<TilePlace> places_of(const TiledWay& way) {
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
    return places;
  }

  void add(const TiledWay& way) {
    const std::set<TilePlace> places = places_of(way);
    for (const TilePlace& place : places) tiles_[place].content.ways.push_back(way);
    in_memory_ += way.nodes.size() * places.size();
    if (in_memory_ > nodes_in_memory) put_away();
  }

  void add(const MapRestriction& restriction, const TiledNode& via) {
    tiles_[place_of(via)].content.restrictions.push_back(restriction);
  }

  // Writes the whole file. Adds to the table what is known only now: the tiles, and the sides of
  // opposite carriageways.
  void write(const std::filesystem::path& result, TileTable& table) {
    put_away();
    waiting_.flush();
    require_written();
    WholeFile out(result);
    std::uint64_t offset = 0;
    const auto append = [&](const Bytes& bytes) {
      out.write(bytes);
      offset += bytes.size();
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
    out.replace_head(sealed(head));
    out.keep();
  }

 private:
  static constexpr std::size_t nodes_in_memory = 1 << 22;  // of ways that wait to be written
  // In tiles; a longer segment is only in the tiles of its ends.
  static constexpr std::int32_t longest_segment = 20;

  struct Piece {
    std::uint64_t offset = 0, size = 0;  // bytes in the waiting file
  };
  struct Collected {
    Tile content;
    std::vector<Piece> pieces;
  };

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

}  // namespace maploop::mapmatch
