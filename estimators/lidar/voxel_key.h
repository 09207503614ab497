// This key numbers the cells of a cubic grid.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace maploop::lidar {

// Uses 21 bits per axis: one million cells to either side of the origin. Keys sort by x, then y,
// then z.
struct VoxelKey {
  std::uint64_t bits = 0;

  static constexpr int half = 1 << 20;

  static VoxelKey of(const Eigen::Vector3i& cell) {
    const auto part = [](int i) { return static_cast<std::uint64_t>(i + half) & 0x1fffff; };
    return {part(cell.x()) << 42 | part(cell.y()) << 21 | part(cell.z())};
  }
  Eigen::Vector3i cell() const {
    const auto part = [this](int shift) {
      return static_cast<int>(bits >> shift & 0x1fffff) - half;
    };
    return {part(42), part(21), part(0)};
  }
  friend auto operator<=>(const VoxelKey&, const VoxelKey&) = default;
};

// Avoids floor(), which is a library call on machines without an instruction for it.
template <class Scalar>
int floor_to_int(Scalar x) {
  const int i = static_cast<int>(x);
  return i - static_cast<int>(x < static_cast<Scalar>(i));
}

}  // namespace maploop::lidar
