// A drive with nothing but a GNSS receiver: RINEX observations, and the products to position with.
#pragma once

#include <filesystem>
#include <memory>

#include "ppp/gnss_files.h"
#include "ppp/ppp_setup.h"
#include "runtime/vehicle/gnss_epoch.h"
#include "runtime/vehicle/vehicle_config.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Whether the path is a file of RINEX observations, or a folder without images that holds one.
bool is_gnss_drive(const std::filesystem::path& path);

class GnssDrive {
 public:
  // `path` is a file of observations, or a folder with one. Products are those that [ppp] products
  // names, each a file or a folder; without any, what lies beside the observations. In folders,
  // what is no GNSS file is passed over, and so are other receivers' observations. Throws
  // std::runtime_error (ppp::ReadError) that names the file and what to do.
  GnssDrive(const std::filesystem::path& path, const VehicleConfig& config);
  GnssDrive(const GnssDrive&) = delete;
  GnssDrive& operator=(const GnssDrive&) = delete;

  const ppp::PppSetup& setup() const { return *setup_; }
  Time first_stamp() const;
  Time last_stamp() const;

  // From the start of the drive, at the receiver's own rate. It may outlive the drive no more than
  // `drive` keeps it.
  static std::unique_ptr<sensors::Source<GnssEpoch>> epochs(std::shared_ptr<const GnssDrive> drive);

 private:
  ppp::GnssFiles files_;
  std::unique_ptr<ppp::PppSetup> setup_;
  Duration latency_;
};

}  // namespace maploop::vehicle
