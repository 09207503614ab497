// GnssDrive is a drive of a GNSS receiver alone: RINEX observations, and the products for
// positioning.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "ppp/gnss_files.h"
#include "ppp/ppp_setup.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "runtime/vehicle/graph/sensors.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Returns whether `path` is a file of RINEX observations, or a folder without images that contains
// one.
bool is_gnss_drive(const std::filesystem::path& path);

class GnssDrive {
 public:
  // `path` is a file of observations, or a folder with exactly one. The products are the files and
  // folders named by [ppp] products; if none is named, they are the files beside the observations.
  // In folders, files that are not GNSS files and the observations of other receivers are skipped.
  // Throws std::runtime_error (ppp::ReadError) that names the file and what to do.
  GnssDrive(const std::filesystem::path& path, const VehicleConfig& config);
  // Does the same for the observations of a recording, which have been read already; the products
  // may be files beside it.
  GnssDrive(const std::filesystem::path& recording, const std::string& observations,
            const VehicleConfig& config);
  GnssDrive(const GnssDrive&) = delete;
  GnssDrive& operator=(const GnssDrive&) = delete;

  const ppp::PppSetup& setup() const { return *setup_; }
  Time first_stamp() const;
  Time last_stamp() const;

  // Returns the epochs from the start of the drive at the receiver's own rate: `stamp` is UTC, and
  // `available` is [ppp] latency later. The source keeps `drive` alive.
  static std::unique_ptr<sensors::Source<GnssEpoch>> epochs(std::shared_ptr<const GnssDrive> drive);

 private:
  void read_products(const std::filesystem::path& observations, const VehicleConfig& config);

  ppp::GnssFiles files_;
  std::unique_ptr<ppp::PppSetup> setup_;
  Duration latency_;
};

// The epochs of `drive` take the place of fixes.
void use_observations(Sensors& sensors, const std::shared_ptr<const GnssDrive>& drive);

}  // namespace maploop::vehicle
