#include "estimators/lidar/voxel_index.h"

#include <algorithm>
#include <bit>

namespace maploop::lidar {

VoxelIndex::VoxelIndex(std::size_t capacity) : capacity_(capacity) {
  const std::size_t slots = std::bit_ceil(2 * capacity + 2);
  entries_.resize(slots);
  mask_ = slots - 1;
  shift_ = 64 - std::countr_zero(slots);
}

void VoxelIndex::clear() {
  std::fill(entries_.begin(), entries_.end(), Entry{});
  used_ = 0;
}

std::int32_t VoxelIndex::find_or_insert(VoxelKey key, std::int32_t value) {
  for (std::size_t slot = slot_of(key);; slot = (slot + 1) & mask_) {
    Entry& entry = entries_[slot];
    if (entry.value == none) {
      if (used_ == capacity_) return none;
      ++used_;
      entry = {key, value};
      return value;
    }
    if (entry.key == key) return entry.value;
  }
}

}  // namespace maploop::lidar
