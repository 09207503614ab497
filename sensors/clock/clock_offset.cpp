#include "sensors/clock/clock_offset.h"

#include <algorithm>

namespace maploop::sensors {

Duration ClockOffset::line_at(Duration device) const {
  return anchor_.offset + from_seconds(slope_ * to_seconds(device - anchor_.device));
}

Time ClockOffset::to_host(Duration device) const {
  return Time(device + line_at(device));
}

void ClockOffset::restart(Point p) {
  first_ = 0;
  count_ = 1;
  points_[0] = anchor_ = p;
  bucket_began_ = newest_ = p.device;
  late_buckets_ = 0;
  slope_ = 0.0;
  delay_ = {};
  late_ = false;
}

bool ClockOffset::add(Duration device, Time arrival) {
  const Point p{device, arrival.time_since_epoch() - device};
  if (count_ == 0) {
    restart(p);
    return false;
  }
  delay_ = p.offset - line_at(device);
  const bool was_late = late_;
  late_ = delay_ > parameters_.jump;
  if (late_ && !was_late) late_since_ = arrival;
  if (delay_ < -parameters_.jump || device < newest_ - parameters_.reordered ||
      (late_ && arrival - late_since_ > parameters_.patience)) {
    restart(p);
    ++jumps_;
    return true;
  }
  newest_ = std::max(newest_, device);
  if (device - bucket_began_ >= parameters_.bucket) {
    const Point& complete = point(count_ - 1);
    if (set_back(complete.offset - line_at(complete.device))) {
      restart(p);
      ++jumps_;
      return true;
    }
    if (count_ == max_buckets) {
      first_ = (first_ + 1) % max_buckets;
    } else {
      ++count_;
    }
    bucket_began_ = device;
    point(count_ - 1) = p;
    fit();
  } else if (p.offset < point(count_ - 1).offset) {
    point(count_ - 1) = p;
  }
  // No message arrives before it was sent, so the line lies under all points.
  if (p.offset < line_at(device)) anchor_ = p;
  delay_ = std::max(delay_, Duration::zero());
  return false;
}

// Returns whether the last buckets, the newest of which is `late`, show a clock that was set back.
// The delay of a busy link would vary between buckets.
bool ClockOffset::set_back(Duration late) {
  if (late < parameters_.step) {
    late_buckets_ = 0;
    return false;
  }
  const bool the_same = late_buckets_ > 0 && std::chrono::abs(late - late_by_) < parameters_.steady;
  late_buckets_ = the_same ? late_buckets_ + 1 : 1;
  if (!the_same) late_by_ = late;
  return late_buckets_ >= parameters_.step_buckets;
}

// Takes the slope from that edge of the lower convex hull which spans the middle of the observed
// time; with too few buckets the line stays level, at the lowest point. The newest bucket is
// incomplete, but any of its points may be the lowest.
void ClockOffset::fit() {
  std::array<std::size_t, max_buckets> hull{};
  std::size_t size = 0;
  const auto turn = [this](std::size_t a, std::size_t b, std::size_t c) {
    const Point &p = point(a), &q = point(b), &r = point(c);
    return to_seconds(q.device - p.device) * to_seconds(r.offset - p.offset) -
           to_seconds(r.device - p.device) * to_seconds(q.offset - p.offset);
  };
  for (std::size_t i = 0; i < count_; ++i) {
    while (size >= 2 && turn(hull[size - 2], hull[size - 1], i) <= 0.0) --size;
    hull[size++] = i;
  }
  if (count_ >= parameters_.drift_buckets) {
    const Duration middle = point(0).device + (point(count_ - 1).device - point(0).device) / 2;
    std::size_t right = 1;
    while (right + 1 < size && point(hull[right]).device < middle) ++right;
    const Point &a = point(hull[right - 1]), &b = point(hull[right]);
    slope_ = std::clamp(to_seconds(b.offset - a.offset) / to_seconds(b.device - a.device),
                        -parameters_.max_drift, parameters_.max_drift);
  }
  // The line of that slope is moved under all points.
  anchor_ = point(0);
  for (std::size_t i = 1; i < count_; ++i) {
    if (point(i).offset < line_at(point(i).device)) anchor_ = point(i);
  }
}

}  // namespace maploop::sensors
