// This file replays a drive given as tables: a GNSS receiver's fixes, and the samples of an
// inertial unit in any mount.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "msgs/gnss.h"
#include "msgs/reference.h"
#include "sensors/imu/aligned_imu.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Holds the samples of one table, and what is wrong with each.
template <class T>
struct TableRows;

// sensors/FORMATS.md describes the files, each plain or .gz: gnss.csv, and optionally imu.csv,
// reference_position.csv and reference_attitude.csv. All are read at once; the sources may outlive
// the recording. Everything is available at its own stamp. A row with a wrong value or stamp is
// left out and reported by its source.
class TableRecording {
 public:
  // Returns whether the path is a folder with gnss.csv or imu.csv.
  static bool is_named(const std::filesystem::path& path);

  // Throws std::runtime_error that names file and line: a needed file or column is missing, a line
  // is not the numbers of the heading, or no row of a table can be used (the reference's excepted:
  // a receiver may never have started it).
  explicit TableRecording(const std::filesystem::path& folder);

  bool has_imu() const { return imu_ != nullptr; }
  bool has_reference() const { return reference_ != nullptr; }
  std::size_t fix_count() const;
  Time first_stamp() const;  // of the usable fixes
  Time last_stamp() const;

  // Each call returns a new source from the start of the recording.

  std::unique_ptr<Source<GnssFix>> gnss() const;
  // Finds the unit's mount with `fixes`, which are those that the vehicle has. Throws
  // std::runtime_error if the recording has no inertial samples.
  std::unique_ptr<AlignedImu> imu(std::unique_ptr<Source<GnssFix>> fixes,
                                  const MountParameters& parameters,
                                  double rear_axle_distance) const;
  // Receivers with an inertial unit lie in the cabin; this is how far it is ahead of the rear axle
  // where nothing else is known.
  static constexpr double cabin_ahead = 1.5;  // m

  // The receiver's own fusion; the accuracy that it states for each row is `reference_accuracy`,
  // because the tables state none.
  std::unique_ptr<Source<ReferencePose>> reference() const;
  static constexpr double reference_accuracy = 1.0;  // m

 private:
  std::shared_ptr<const TableRows<GnssFix>> gnss_;
  std::shared_ptr<const TableRows<SixAxisSample>> imu_;        // nullptr: none were recorded
  std::shared_ptr<const TableRows<ReferencePose>> reference_;  // nullptr: there is none
};

}  // namespace maploop::sensors
