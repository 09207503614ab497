#include "tools/replay/car_memory.h"

#include <iostream>
#include <stdexcept>
#include <string>
#include <utility>

#include "runtime/core/data_clock.h"
#include "runtime/vehicle/config/kept_ppp.h"
#include "runtime/vehicle/graph/stage_specs.h"
#include "runtime/vehicle/stages/ppp_counts.h"
#include "tools/command/attempt.h"

namespace maploop::tools {
namespace {

// Renames a damaged file, and returns in words what has become of it.
std::string set_aside(const std::filesystem::path& file) {
  std::filesystem::path aside = file;
  aside += ".damaged";
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) {
    std::filesystem::rename(file, aside, error);
    if (!error) return "the file is kept as '" + aside.string() + "'";
  }
  return "it cannot be kept as '" + aside.string() + "'";
}

}  // namespace

CarMemory::CarMemory(std::filesystem::path file, const vehicle::VehicleConfig& config)
    : file_(std::move(file)), ppp_file_(file_), config_(config) {
  ppp_file_ += ".ppp";
}

// A computer that nobody attends starts without a damaged file, and keeps it to be looked at.
std::optional<vehicle::CarState> CarMemory::known() const {
  try {
    return vehicle::read_car_state(file_, config_.vehicle.car.name);
  } catch (const vehicle::DamagedCarState& damage) {
    std::cerr << "maploop: " << damage.what() << "; " << set_aside(file_)
              << ", and this run starts without it\n";
    return std::nullopt;
  }
}

void CarMemory::recall(vehicle::Vehicle& vehicle) {
  if (file_.empty()) return;
  if (const std::optional<vehicle::CarState> state = known()) {
    remembered_ = state->calibration;
    vehicle.recall(state->calibration);
    if (state->place) vehicle.recall(*state->place);
  }
  recall_ppp(vehicle);
}

void CarMemory::recall_ppp(vehicle::Vehicle& vehicle) const {
  if (!vehicle.has(vehicle::stages::ppp)) return;
  std::optional<Bytes> filter;
  try {
    filter = vehicle::read_kept_ppp(ppp_file_, config_.vehicle.car.name);
  } catch (const vehicle::DamagedCarState& damage) {
    std::cerr << "maploop: " << damage.what() << "; " << set_aside(ppp_file_)
              << ", and PPP starts without it\n";
  }
  try {
    if (filter) vehicle.recall(vehicle::stages::ppp, *filter);
  } catch (const ArchiveError& other) {
    std::cerr << "maploop: '" << ppp_file_.string() << "' is not used, because " << other.what()
              << "; PPP starts without it\n";
  }
}

void CarMemory::say_place(fusion::PlaceUse use) {
  if (!fusion::dropped(use) || use == said_) return;
  said_ = use;
  std::cerr << "maploop: " << to_string(use) << ", so '" << file_.string()
            << "' gives no position to start from; the first fix does\n";
}

void CarMemory::say_ppp(const Health& health) const {
  for (const RefusalCount& refused : health.refusals) {
    if (refused.reason != vehicle::PppCounts::of_another_time) continue;
    std::cerr
        << "maploop: '" << ppp_file_.string()
        << "' is of another time than this run's first epoch, so PPP has started without it\n";
  }
}

void CarMemory::observe(vehicle::Observer& observer) {
  if (file_.empty()) return;
  written_ = runtime::monotonic_now();
  observer.calibration = [this](const vehicle::CalibrationReport& estimated) {
    const std::lock_guard lock(mutex_);
    noted_.at = estimated.stamp;
    noted_.calibration = estimated.properties;
  };
  observer.place = [this](fusion::PlaceUse use, const std::optional<fusion::LastPlace>& here) {
    const std::lock_guard lock(mutex_);
    use_ = use;
    noted_.place = here;
  };
}

void CarMemory::observe_ppp(vehicle::Vehicle& vehicle, Duration every) {
  if (file_.empty() || !vehicle.has(vehicle::stages::ppp)) return;
  vehicle.take_snapshots(every, [this](const vehicle::Snapshot& all) {
    const std::lock_guard lock(mutex_);
    ppp_ = *all.part(vehicle::stages::ppp.name);
  });
}

void CarMemory::update() {
  constexpr Duration every = std::chrono::seconds(2);
  if (file_.empty() || runtime::monotonic_now() - written_ < every) return;
  written_ = runtime::monotonic_now();
  vehicle::CarEstimate state;
  std::optional<Bytes> ppp;
  fusion::PlaceUse use{};
  {
    const std::lock_guard lock(mutex_);
    state = noted_;
    ppp = std::exchange(ppp_, std::nullopt);
    use = use_;
  }
  say_place(use);
  state.before = remembered_;
  write(state, ppp);
}

bool CarMemory::write(const vehicle::VehicleReport& end) {
  if (file_.empty()) return true;
  say_place(end.place);
  say_ppp(end.health);
  if (end.ppp) ppp_ = end.ppp;
  const auto kept = write({end.last, end.calibration, end.here, remembered_}, ppp_);
  if (kept == 0U) {
    std::cerr << "maploop: '" << file_.string()
              << "' is not written, because no position had an azimuth\n";
  }
  return kept.has_value();
}

std::optional<std::size_t> CarMemory::write(const vehicle::CarEstimate& state,
                                            const std::optional<Bytes>& ppp) const {
  std::optional<std::size_t> kept;
  attempt([&] {
    const std::size_t values = vehicle::write_car_state(file_, config_.vehicle.car.name, state);
    if (ppp) vehicle::write_kept_ppp(ppp_file_, config_.vehicle.car.name, *ppp);
    kept = values;
  });
  return kept;
}

}  // namespace maploop::tools
