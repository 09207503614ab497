// The nodes of all roads of a map: first their ids are collected, then their places.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <osmium/osm/location.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mapmatch/tiled_map_format.h"

namespace maploop::mapmatch {

// Takes 16 bytes for each node. Throws std::runtime_error if there are more than `max_nodes`.
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
  static constexpr std::size_t ids_at_once = 1 << 24;  // 128 MB
  static constexpr int few = 16;                       // steps that cost less than a search

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

}  // namespace maploop::mapmatch
