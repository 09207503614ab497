// A recorded drive in any form that can be replayed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/calibration.h"
#include "runtime/vehicle/gnss_outage.h"
#include "runtime/vehicle/vehicle.h"
#include "runtime/vehicle/vehicle_config.h"

namespace maploop::vehicle {

// Of the road links really driven.
struct DrivenLinksFile {
  std::filesystem::path file;
  std::vector<Time> stamps;  // of the frames that it numbers
};

struct Recording {
  VehicleCalibration calibration;
  Time first_stamp{};  // of the images, or of what stands for them
  Time last_stamp{};
  std::size_t images = 0;
  // Anew, each from the start; those that it has. Pixels and points of what is available up to
  // `passed` may be missing, which saves reading them.
  std::function<Sensors(Time passed)> sensors;
  std::vector<GnssOutage> outages;              // as configured; the sensors have them
  std::optional<DrivenLinksFile> driven_links;  // where the recording has one
};

// A KITTI raw drive, with the raw cameras that the configuration may name.
std::shared_ptr<const sensors::KittiDrive> open_drive(const std::filesystem::path& folder,
                                                      const VehicleConfig& config);

// A KITTI raw drive (a folder; driven_links.csv beside it are its labels; with a folder `gnss` in
// it, which holds a receiver's observations, these are its GNSS unless [ppp] observations says no),
// a capture of a Velodyne scanner (.pcap, .pcapng, plain or .gz; of an HDL-64E with [live]
// velodyne_calibration), RINEX observations with their products (gnss_drive.h), a table of OXTS
// rows such as a sequence of KITTI's odometry benchmark (sensors/replay/sequence_files.h), or one
// of our own logs (any other file). A log without images gives the odometry that was made from
// them; a sequence, the stereo back end's from its recorded tracks. Throws std::runtime_error
// naming what is wrong with it.
Recording open_recording(const std::filesystem::path& path, const VehicleConfig& config);

// The first pose of the recording's reference, for dead reckoning from a start without error.
// Throws std::runtime_error where it has none.
fusion::KnownStart start_from_reference(const Recording& recording);

}  // namespace maploop::vehicle
