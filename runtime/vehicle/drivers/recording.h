// Opens a recorded drive in any form that can be replayed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "msgs/calibration.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/gnss_outage.h"
#include "runtime/vehicle/graph/vehicle.h"

namespace maploop::vehicle {

// DrivenLinksFile names the file of the road links that were really driven.
struct DrivenLinksFile {
  std::filesystem::path file;
  std::vector<Time> stamps;  // of the frames that the file numbers
};

struct Recording {
  VehicleCalibration calibration;
  Time first_stamp{};  // of the images; if there are none, of epochs or scans
  Time last_stamp{};
  std::size_t images = 0;  // number of images; if there are none, of epochs or scans
  // Returns new sources of the sensors that were recorded, each from the start. Pixels and points
  // of samples that are available up to `passed` may be missing, which saves reading them.
  std::function<Sensors(Time passed)> sensors;
  std::vector<GnssOutage> outages;              // as configured; `sensors` applies them
  std::optional<DrivenLinksFile> driven_links;  // if the recording has one
};

// Opens a KITTI raw drive, with the calibration of raw cameras that the configuration may name.
std::shared_ptr<const sensors::KittiDrive> open_drive(const std::filesystem::path& folder,
                                                      const VehicleConfig& config);

// Opens a recording. Throws std::runtime_error naming what is wrong with it. `path` is one of
// these:
// - A KITTI raw drive is a folder. driven_links.csv beside it contains its labels. A receiver's
//   observations in a folder `gnss` in it replace its GNSS, unless [ppp] observations is false.
// - A capture of a Velodyne scanner is .pcap or .pcapng, plain or .gz; that of an HDL-64E needs
//   [vehicle.lidar] calibration.
// - RINEX observations are read with their products (gnss_drive.h).
// - A table of OXTS rows is, for example, a sequence of KITTI's odometry benchmark
//   (sensors/replay/sequence_files.h). The stereo back end computes its odometry from its recorded
//   tracks.
// - Any other file is a log of maploop. A log without images contains the odometry that was
//   computed from them.
Recording open_recording(const std::filesystem::path& path, const VehicleConfig& config);

// Returns the first pose of the recording's reference, for dead reckoning from a start without
// error. Throws std::runtime_error if there is no reference.
fusion::KnownStart start_from_reference(const Recording& recording);

}  // namespace maploop::vehicle
