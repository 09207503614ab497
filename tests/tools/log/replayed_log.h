// Compares what a log and the file that it was converted to are replayed as.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "sensors/replay/log_recording.h"

namespace maploop::testing {

// Expects the same frames and scans of both; returns the number of scans.
inline int expect_replayed_alike(const std::filesystem::path& converted,
                                 const std::filesystem::path& from) {
  const sensors::LogRecording ours(converted), log(from);
  EXPECT_EQ(ours.frame_count(), log.frame_count());
  EXPECT_EQ(ours.first_stamp(), log.first_stamp());
  const auto scans = ours.source<LidarScan>(channel_names::velodyne),
             same_scans = log.source<LidarScan>(channel_names::velodyne);
  LidarScan scan, same;
  int count = 0;
  for (; same_scans->next(same); ++count) {
    if (!scans->next(scan)) break;
    EXPECT_EQ(schema::encoded(to_lcm(scan)), schema::encoded(to_lcm(same)));
  }
  EXPECT_FALSE(scans->next(scan));
  EXPECT_FALSE(same_scans->next(same));
  return count;
}

}  // namespace maploop::testing
