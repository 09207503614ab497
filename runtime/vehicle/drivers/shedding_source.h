// A live sensor of which less is used while the vehicle sheds load.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "msgs/image.h"
#include "msgs/lidar_scan.h"
#include "runtime/vehicle/health/load_shedding.h"
#include "sensors/live/live_source.h"

namespace maploop::vehicle {

// Keeps every n-th point.
inline void thin(LidarScan& scan, std::size_t n) {
  const auto keep = [n](auto& values) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); i += n) values[kept++] = values[i];
    values.resize(kept);
  };
  keep(scan.points);
  keep(scan.times);
}

// Thins scans, and leaves image pairs out.
template <class T>
class SheddingSource final : public sensors::LiveSource<T> {
 public:
  SheddingSource(std::unique_ptr<sensors::LiveSource<T>> source,
                 std::shared_ptr<const LoadShedding> load)
      : source_(std::move(source)), load_(std::move(load)) {}

  bool wait(T& sample, Duration patience) override {
    return source_->wait(sample, patience) && is_used(sample);
  }

  sensors::LiveReport report() const override { return source_->report(); }
  std::uint64_t shed() const override { return shed_.load(std::memory_order_relaxed); }

 private:
  bool is_used(LidarScan& scan) {
    const int n = load_->points_one_of();
    if (n > 1) {
      thin(scan, static_cast<std::size_t>(n));
      shed_.fetch_add(1, std::memory_order_relaxed);
    }
    return true;
  }

  bool is_used(const StereoPair& pair) {
    const int n = load_->pairs_one_of();
    if (n == 1 || pair.sequence % static_cast<std::uint64_t>(n) == 0) return true;
    shed_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }

  std::unique_ptr<sensors::LiveSource<T>> source_;
  std::shared_ptr<const LoadShedding> load_;
  std::atomic<std::uint64_t> shed_{0};
};

}  // namespace maploop::vehicle
