// This file reads a folder of scans: clouds (.pcd, .ply) and KITTI's frames (.bin).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Delivers the scans in the order of their names, in which numbers count as numbers: scan9.pcd is
// before scan10.pcd. Each may also be .gz. Scans that cannot be read are left out and reported.
//
// The points of a scan count as measured at its stamp, so `start` and `end` are a nanosecond before
// and after it: an estimator that derives times from azimuths does not move the points. Whoever
// corrects them for the vehicle's motion does it with times().
class ScanFolder final : public Source<LidarScan> {
 public:
  static bool is(const std::filesystem::path& folder);  // contains a scan

  // A file of stamps has a line for each scan: a number of seconds, or KITTI's time stamp
  // (replay/timestamps.h). If none is named (empty path), it is timestamps.txt in the folder, and
  // without that, scans are 0.1 s apart. Throws std::runtime_error that names the folder without a
  // scan, or the file of stamps and what is wrong in which line.
  explicit ScanFolder(const std::filesystem::path& folder, std::filesystem::path stamps = {});

  bool next(LidarScan& scan) override;
  const SourceReport& report() const override { return report_; }

  // Returns when each point of the last scan was measured, in seconds after its stamp, which counts
  // as the middle of these times; empty if the file has no field of times, or only one time. The
  // file may count from anywhere, in s, ms, us or ns: the unit is the one in which the scan takes
  // 0.5 to 500 ms.
  std::span<const float> times() const { return times_; }

  // Returns sentences about the stamps, the times and the unreadable scans so far.
  std::string remarks() const;

 private:
  void read(const std::filesystem::path& file, std::vector<LidarPoint>& points);

  std::vector<std::filesystem::path> files_;
  std::vector<Time> stamps_;
  std::size_t next_ = 0;
  std::vector<float> times_;
  bool stamped_ = false, timed_ = false;
  SourceReport report_;
};

}  // namespace maploop::sensors
