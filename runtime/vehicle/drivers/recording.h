// Opens a recorded drive in any form that can be replayed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msgs/calibration.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/gnss_outage.h"
#include "runtime/vehicle/drivers/sensor_delays.h"
#include "runtime/vehicle/graph/vehicle.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/imu/mount_alignment.h"

namespace maploop::sensors {
struct BagSummary;
}

namespace maploop::vehicle {

// KnownContents is the summary of a bag that was read before the bag is opened. It spares a bag
// without an index a second reading. It is nullptr for other recordings.
using KnownContents = std::shared_ptr<const sensors::BagSummary>;

// DrivenLinksFile names the file of the road links that were really driven.
struct DrivenLinksFile {
  std::filesystem::path file;
  std::vector<Time> stamps;  // of the frames that the file numbers
};

struct Recording {
  VehicleCalibration calibration;
  Time first_stamp{};  // as recorded, of the images; if there are none, of epochs or scans
  Time last_stamp{};
  std::size_t images = 0;        // number of images; if there are none, of epochs or scans
  bool wheels_are_made = false;  // wheel speeds are made from the recorder's speed
  // Returns new sources of the sensors that were recorded, each from the start. Pixels and points
  // of samples that are available up to `passed` may be missing, which saves reading them.
  std::function<Sensors(Time passed)> sensors;
  SensorDelays delays{};            // that its stamps contain; `sensors` takes them off
  std::vector<GnssOutage> outages;  // as configured; `sensors` applies them
  // Returns every fix, also those that the outages take away, to score with. Null: they are made
  // from the reference, which scores better.
  std::function<std::unique_ptr<sensors::Source<GnssFix>>()> fixes;
  std::optional<DrivenLinksFile> driven_links;  // if the recording has one
  std::vector<std::string> notes;  // sentences for the user: what is not used, what was assumed
};

// Opens a recording. Throws std::runtime_error naming what is wrong with it. `path` is one of
// these:
// - A folder of images, scans and rows is in EuRoC's format, KITTI-360's, lists of images and
// clouds,
//   or a KITTI raw drive (sensors/FORMATS.md).
// - A KITTI raw drive is a folder. driven_links.csv beside it contains its labels. A receiver's
//   observations in a folder `gnss` in it replace its GNSS, unless [ppp] observations is false.
// - A capture of a Velodyne scanner is .pcap or .pcapng, plain or .gz; that of an HDL-64E needs
//   [vehicle.lidar] calibration.
// - RINEX observations are read with their products (gnss_drive.h).
// - Tables are a folder with gnss.csv or maploop.tables.toml, or a .pos file. [vehicle.imu] may
// state how
//   the unit is mounted; otherwise it is found on the way.
// - A ROS 1 bag, a rosbag2 folder or an MCAP file has the topics that [bag] names, or those that
//   are found by their types (sensors/bag/bag_recording.h).
// - A table of OXTS rows is, for example, a sequence of KITTI's odometry benchmark
//   (sensors/replay/sequence_files.h). The stereo back end computes its odometry from its recorded
//   tracks.
// - Any other file is a log of maploop, LCM or MCAP. A log without images contains the odometry
// that
//   was computed from them.
Recording open_recording(const std::filesystem::path& path, const VehicleConfig& config,
                         const KnownContents& contents = nullptr);

// Chooses what tables, bags and logs of them need, where the configuration file has not said
// otherwise: without odometry and wheels they are run as GNSS+RI, or as GNSS without an inertial
// unit, which is of grade mems. Other recordings need nothing. Returns what open_recording() of the
// same path can use. Throws as that does.
KnownContents fit_to_recording(VehicleConfig& config, const std::filesystem::path& path);

// Returns the outages that the configuration asks for. Throws std::runtime_error if it does not use
// GNSS.
std::vector<GnssOutage> outages_of(const VehicleConfig& config, const Recording& recording);

// Returns the calibration of raw cameras that [vehicle.camera] names; nothing: it names none.
std::optional<sensors::StereoRig> raw_cameras(const VehicleConfig& config);

// Returns how [vehicle.imu] says that the unit is mounted. Its pitch is nose up.
sensors::MountParameters mount_of(const VehicleConfig& config);

// Returns the first pose of the recording's reference, for dead reckoning from a start without
// error. Throws std::runtime_error if there is no reference.
fusion::KnownStart start_from_reference(const Recording& recording);

}  // namespace maploop::vehicle
