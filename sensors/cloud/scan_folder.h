// This file reads a folder of scans: clouds (.pcd, .ply) and KITTI's frames (.bin).
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Delivers the scans in the order of their names, in which numbers count as numbers: scan9.pcd is
// before scan10.pcd. Each may also be .gz. Scans that cannot be read are left out and reported.
//
// A file's times may count from anywhere, in s, ms, us or ns: the unit is the one in which the scan
// takes 0.5 to 500 ms, and their middle is the scan's stamp. Without times, or with one time only,
// the points count as measured at the stamp: `start` and `end` are a nanosecond before and after
// it, so that azimuths do not move them.
class ScanFolder final : public Source<LidarScan> {
 public:
  static bool is(const std::filesystem::path& folder);  // contains a scan

  // A file of stamps has a line for each scan (folder/stamps.h). If none is named (empty path), it
  // is timestamps.txt or times.txt in the folder or in the one above it; without that the names of
  // the scans are their stamps; and if they are not, scans are 0.1 s apart. Throws
  // std::runtime_error that names the folder without a scan, or the file of stamps and what is
  // wrong in which line.
  explicit ScanFolder(const std::filesystem::path& folder, std::filesystem::path stamps = {});

  bool next(LidarScan& scan) override;
  const SourceReport& report() const override { return report_; }

  const std::vector<Time>& stamps() const { return stamps_; }
  // Scans with a stamp up to this one are delivered without points, and are not read.
  void pass_until(Time passed) { passed_ = passed; }

  // Says how the scans are stamped, if that is assumed; an empty text if it is known.
  std::string assumption() const;

  // Returns sentences about the stamps, the times and the unreadable scans so far.
  std::string remarks() const;

 private:
  void read(const std::filesystem::path& file, LidarScan& scan);
  void find_stamps(const std::filesystem::path& folder, std::filesystem::path file);

  std::vector<std::filesystem::path> files_;
  std::vector<Time> stamps_;
  Time passed_ = Time::min();
  std::size_t next_ = 0;
  bool stamped_ = false, timed_ = false;
  SourceReport report_;
};

// Returns the scans of a folder as a vehicle takes them, in the same way as a bag's clouds: as
// bag/cloud_scans.h says if the points have times; otherwise a scan is a turn, whose stamp is its
// middle.
std::unique_ptr<Source<LidarScan>> make_scan_source(const std::filesystem::path& folder,
                                                    Duration max_turn, Time passed);

}  // namespace maploop::sensors
