#include "runtime/vehicle/stages/map_window.h"

#include <cmath>
#include <utility>

#include "mapmatch/map_area.h"

namespace maploop::vehicle {
namespace {

constexpr double reach = 4000.0;         // m from the middle to each side
constexpr double begins_at = 2000.0;     // m from the middle, to read the next one
constexpr double goes_over_at = 2500.0;  // m

double distance(const Geodetic& a, const Geodetic& b) {
  return LocalFrame(a).to_enu({b.latitude, b.longitude, a.height}).head<2>().norm();
}

runtime::Scheduling without_priority() {
  runtime::Scheduling scheduling;
  scheduling.policy = runtime::SchedulingPolicy::other;
  scheduling.nice = 10;
  return scheduling;
}

}  // namespace

MapWindow::MapWindow(std::shared_ptr<const RoadMap> map)
    : map_(std::move(map)), network_(map_, &map_->network) {}

bool MapWindow::follow(const Geodetic& place) {
  if (!moves() || !std::isfinite(place.latitude) || !std::isfinite(place.longitude)) return false;
  const double from_middle = middle_ ? distance(*middle_, place) : 2.0 * reach;
  if (from_middle > goes_over_at) {
    if (!reading_ || distance(reading_->middle, place) > begins_at) reading_ = begin(place);
    go_over(std::move(reading_));
    return true;
  }
  if (from_middle > begins_at && !reading_) reading_ = begin(place);
  return false;
}

std::unique_ptr<MapWindow::Reading> MapWindow::begin(const Geodetic& middle) const {
  auto reading = std::make_unique<Reading>();
  reading->middle = middle;
  reading->thread.emplace(
      "map-window", without_priority(), std::stop_token(),
      [map = map_, to = reading.get()](const std::stop_token&) {
        to->network = network_within(*map, mapmatch::around(to->middle, reach));
      },
      [] {});
  return reading;
}

void MapWindow::go_over(std::unique_ptr<Reading> reading) {
  reading->thread->join();
  middle_ = reading->middle;
  network_ = reading->network;
  if (network_ == nullptr) {
    failures_.fetch_add(1, std::memory_order_relaxed);
    network_ = {map_, &map_->network};
  }
}

void MapWindow::restore(bool known, const Geodetic& middle, bool begun, const Geodetic& next,
                        std::uint64_t failures) {
  reading_.reset();
  middle_.reset();
  network_ = {map_, &map_->network};
  if (moves() && known) go_over(begin(middle));
  if (moves() && begun) reading_ = begin(next);
  failures_.store(failures, std::memory_order_relaxed);
}

}  // namespace maploop::vehicle
