// This flat hash table of fixed size finds the array index of a voxel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimators/lidar/voxel_key.h"

namespace maploop::lidar {

// Maps up to `capacity` keys to numbers. Allocates only at construction. Uses open addressing with
// linear probing and is at most half full.
class VoxelIndex {
 public:
  static constexpr std::int32_t none = -1;

  explicit VoxelIndex(std::size_t capacity);

  void clear();

  std::int32_t find(VoxelKey key) const {
    for (std::size_t slot = slot_of(key);; slot = (slot + 1) & mask_) {
      const Entry& entry = entries_[slot];
      if (entry.value == none || entry.key == key) return entry.value;
    }
  }

  // Returns the number of the key; a new key gets the number `value`. Returns `none` if the table
  // is full.
  std::int32_t find_or_insert(VoxelKey key, std::int32_t value);

 private:
  struct Entry {
    VoxelKey key;
    std::int32_t value = none;
  };

  std::size_t slot_of(VoxelKey key) const {
    return static_cast<std::size_t>(key.bits * 0x9e3779b97f4a7c15u >> shift_);
  }

  std::size_t capacity_;
  std::size_t used_ = 0;
  int shift_ = 0;
  std::size_t mask_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace maploop::lidar
