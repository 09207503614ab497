// Keeps what a run knows of the car in files, for the next run to start from (--state).
#pragma once

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>

#include "msgs/archive.h"
#include "msgs/time.h"
#include "runtime/vehicle/config/car_state.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/graph/vehicle.h"

namespace maploop::tools {

// `file` has the place and what was learnt of the car, and FILE.ppp the filter of PPP with its
// ambiguities. Without a name nothing is kept.
class CarMemory {
 public:
  // The configuration must outlive this.
  CarMemory(std::filesystem::path file, const vehicle::VehicleConfig& config);

  // Tells the vehicle what the files say; before start(). A damaged file is renamed and said on
  // standard error; there it is said, too, that a filter of PPP has other settings. Throws
  // std::runtime_error if a file cannot be read, or is of another car.
  void recall(vehicle::Vehicle& vehicle);

  // Writes where the car is, and what has been estimated of it since, every two seconds: a
  // vehicle's computer is often switched off without a warning. `observer` takes note of it on the
  // publisher's thread, and of the filter of PPP, `every` so often, on the snapshot thread.
  // update() writes it on the caller's, and says on standard error what failed, and that the place
  // in the file is not used.
  void observe(vehicle::Observer& observer);
  void observe_ppp(vehicle::Vehicle& vehicle, Duration every);  // before start()
  void update();

  // Writes what the vehicle knew at its end. Returns whether this succeeded.
  bool write(const vehicle::VehicleReport& end);

 private:
  std::optional<vehicle::CarState> known() const;
  void recall_ppp(vehicle::Vehicle& vehicle) const;
  void say_place(fusion::PlaceUse use);
  void say_ppp(const Health& health) const;
  // Returns the number of values of the car that the file has; nothing: writing has failed.
  std::optional<std::size_t> write(const vehicle::CarEstimate& state,
                                   const std::optional<Bytes>& ppp) const;

  std::filesystem::path file_, ppp_file_;
  const vehicle::VehicleConfig& config_;

  std::mutex mutex_;
  vehicle::CarEstimate noted_;
  std::optional<Bytes> ppp_;  // the filter of PPP, not yet written
  fusion::PlaceUse use_{};
  // The caller's alone.
  fusion::RememberedCalibration remembered_;
  fusion::PlaceUse said_{};
  MonotonicTime written_{};
};

}  // namespace maploop::tools
