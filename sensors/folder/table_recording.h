// This file replays a drive given as tables: fixes, inertial samples in any mount, wheel speeds,
// and a reference.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "msgs/gnss.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "sensors/folder/table_mapping.h"
#include "sensors/folder/table_rows.h"
#include "sensors/imu/aligned_imu.h"
#include "sensors/source.h"

namespace maploop::sensors {

// All tables are read at once; the sources may outlive the recording. Everything is available at
// its own stamp. A row with a wrong value or stamp is left out and reported by its source.
class TableRecording {
 public:
  // Returns whether the path is a folder with gnss.csv or imu.csv.
  static bool is_named(const std::filesystem::path& path);

  // Throws std::runtime_error that names file and line: a needed file or column is missing, a line
  // is not the numbers of the heading, or no row of a table can be used (the reference's excepted:
  // a receiver may never have started it).
  explicit TableRecording(const TableMapping& mapping);
  // Reads plain_tables(folder), of which gnss.csv is needed.
  explicit TableRecording(const std::filesystem::path& folder);

  bool has_gnss() const { return gnss_ != nullptr; }
  bool has_imu() const { return imu_ != nullptr; }
  bool has_wheel() const { return wheel_ != nullptr; }
  bool has_reference() const { return reference_ != nullptr; }
  bool has_anything() const { return has_gnss() || has_imu() || has_wheel(); }

  // These are of the usable fixes; if there are none, of the wheel speeds or inertial samples.
  std::size_t fix_count() const;
  Time first_stamp() const;
  Time last_stamp() const;

  // Each call returns a new source from the start of the recording; nullptr: it has no such table.
  std::unique_ptr<Source<GnssFix>> gnss() const;
  std::unique_ptr<Source<WheelSpeed>> wheel() const;
  // Finds the unit's mount with `fixes`, which are those that the vehicle has. Throws
  // std::runtime_error if the recording has no inertial samples.
  std::unique_ptr<AlignedImu> imu(std::unique_ptr<Source<GnssFix>> fixes,
                                  const MountParameters& parameters,
                                  double rear_axle_distance) const;
  // Receivers with an inertial unit lie in the cabin; this is how far it is ahead of the rear axle
  // where nothing else is known.
  static constexpr double cabin_ahead = 1.5;  // m

  std::unique_ptr<Source<ReferencePose>> reference() const;

 private:
  template <class F>
  auto of_main_table(F f) const;

  std::shared_ptr<const TableRows<GnssFix>> gnss_;  // nullptr: there is none
  std::shared_ptr<const TableRows<SixAxisSample>> imu_;
  std::shared_ptr<const TableRows<WheelSpeed>> wheel_;
  std::shared_ptr<const TableRows<ReferencePose>> reference_;
};

}  // namespace maploop::sensors
