#include "sensors/bag/cloud_scans.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "msgs/frames.h"

namespace maploop::sensors {
namespace {

// Scanners turn at most 30 times a second; a pattern that seems to turn faster is another one.
constexpr Duration least_turn = std::chrono::milliseconds(20);

}  // namespace

void CloudScans::add(TimedCloud& cloud) {
  if (scanner_ == Scanner::other) {
    waiting_.push_back(std::move(cloud));
    return;
  }
  if (scanner_ == Scanner::not_known) waiting_.push_back(cloud);
  if (first_ == Time{}) first_ = *std::ranges::min_element(cloud.times);
  std::swap(cloud_, cloud);
  at_ = 0;
  order_.resize(cloud_.points.size());
  std::iota(order_.begin(), order_.end(), 0U);
  const auto earlier = [&](std::uint32_t a, std::uint32_t b) {
    return cloud_.times[a] < cloud_.times[b];
  };
  if (!std::ranges::is_sorted(cloud_.times)) std::ranges::stable_sort(order_, earlier);
}

bool CloudScans::next(LidarScan& scan) {
  if (scanner_ != Scanner::other) {
    const bool turned = next_turn(scan);
    if (turned && (scanner_ == Scanner::turning || scan.end - scan.start >= least_turn)) {
      scanner_ = Scanner::turning;
      waiting_.clear();
      return true;
    }
    const bool long_enough =
        !order_.empty() && cloud_.times[order_.back()] - first_ > 2 * max_turn_;
    if (turned || (scanner_ == Scanner::not_known && long_enough)) scanner_ = Scanner::other;
  }
  if (scanner_ != Scanner::other || waiting_.empty()) return false;
  make_scan(waiting_.front(), scan);
  waiting_.pop_front();
  return true;
}

bool CloudScans::end() {
  if (scanner_ == Scanner::not_known) scanner_ = Scanner::other;
  return scanner_ == Scanner::other && !waiting_.empty();
}

bool CloudScans::next_turn(LidarScan& scan) {
  while (at_ < order_.size()) {
    const std::uint32_t i = order_[at_++];
    const LidarPoint& p = cloud_.points[i];
    const double clockwise = degrees(std::atan2(-p.y, p.x));
    const FiredPoint fired{p, 100.0 * (clockwise < 0.0 ? clockwise + 360.0 : clockwise),
                           Duration{}};
    if (assembler_.add(fired, cloud_.times[i], scan)) {
      scan.available = scan.end;
      return true;
    }
  }
  return false;
}

void CloudScans::make_scan(TimedCloud& cloud, LidarScan& scan) {
  const auto [first, last] = std::ranges::minmax(cloud.times);
  scan.start = first;
  scan.end = scan.available = last;
  scan.stamp = first + (last - first) / 2;
  scan.sequence = sequence_++;
  scan.times.resize(cloud.times.size());
  std::ranges::transform(cloud.times, scan.times.begin(), [&](Time time) {
    return static_cast<float>(to_seconds(time - scan.stamp));
  });
  scan.points.swap(cloud.points);
}

}  // namespace maploop::sensors
