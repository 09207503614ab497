#include "runtime/vehicle/stages/map_window.h"

#include <cmath>
#include <exception>
#include <span>
#include <system_error>
#include <utility>

namespace maploop::vehicle {
namespace {

constexpr double retries_at = 500.0;           // m from the middle
constexpr std::size_t most_nodes = 1'000'000;  // of a window, 100 MB
constexpr double no_window = 1e9;              // m

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
  const WindowSize& size = map_->window;
  const double from_middle = middle_ ? distance(*middle_, place) : no_window;
  if (from_middle > (failed_ ? retries_at : size.goes_over_at)) {
    if (!reading_ || distance(reading_->middle, place) > size.begins_at) reading_ = begin(place);
    go_over(std::move(reading_));
    return true;
  }
  if (from_middle > size.begins_at && !reading_) reading_ = begin(place);
  return false;
}

std::unique_ptr<MapWindow::Reading> MapWindow::begin(const Geodetic& middle) const {
  auto reading = std::make_unique<Reading>();
  reading->middle = middle;
  const auto read = [map = map_, to = reading.get()](const std::stop_token&) {
    try {
      to->network = network_about(*map, std::span(&to->middle, 1), map->window.reach, most_nodes);
    } catch (const std::exception& e) {
      to->error = e.what();
    }
  };
  try {
    reading->thread.emplace("map-window", without_priority(), std::stop_token(), read, [] {});
  } catch (const std::system_error& e) {
    reading->error = std::string("no thread for reading the map: ") + e.what();
  }
  return reading;
}

void MapWindow::go_over(std::unique_ptr<Reading> reading) {
  if (reading->thread) reading->thread->join();
  middle_ = reading->middle;
  network_ = reading->network;
  failed_ = network_ == nullptr;
  if (!failed_) return;
  network_ = {map_, &map_->network};
  const std::scoped_lock lock(mutex_);
  ++failures_.count;
  failures_.last = std::move(reading->error);
}

MapWindow::Failures MapWindow::failures() const {
  const std::scoped_lock lock(mutex_);
  return failures_;
}

void MapWindow::restore(bool known, const Geodetic& middle, bool begun, const Geodetic& next,
                        std::uint64_t failures) {
  reading_.reset();
  middle_.reset();
  failed_ = false;
  network_ = {map_, &map_->network};
  if (moves() && known) go_over(begin(middle));
  if (moves() && begun) reading_ = begin(next);
  const std::scoped_lock lock(mutex_);
  failures_.count = failures;
}

}  // namespace maploop::vehicle
