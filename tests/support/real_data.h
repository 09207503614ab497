// Finds files for tests: the real data, without which tests are skipped with a clear message, and
// the source tree.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace maploop::testing {

// Returns the folder of real data (MAPLOOP_DATA), or an empty path.
std::filesystem::path real_data();

// Returns KITTI raw drive 2011_09_26_drive_0013_sync as tools/restore-drive unpacked it, or an
// empty path.
std::filesystem::path drive_0013();

// Returns a file of this checkout by its path below the root, which tests get in MAPLOOP_SOURCE.
std::filesystem::path source(const std::filesystem::path& file);

// A TemporaryFolder is a new folder for one test's files, and is removed at the test's end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace maploop::testing

#define MAPLOOP_REQUIRE_REAL_DATA()          \
  if (maploop::testing::real_data().empty()) \
  GTEST_SKIP() << "SKIPPED, NOT TESTED: no real data; set MAPLOOP_DATA to its folder"

#define MAPLOOP_REQUIRE_DRIVE()                                                           \
  if (maploop::testing::drive_0013().empty())                                             \
  GTEST_SKIP() << "SKIPPED, NOT TESTED: the recorded drive is missing; set MAPLOOP_DATA " \
                  "and run tools/restore-drive"
