// This file makes a drive of a few frames in a temporary folder, which tests can damage.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sensors/source.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {

class SmallDrive {
 public:
  static constexpr std::size_t frames = 8;
  static constexpr int width = 32, height = 24;
  static constexpr std::size_t points = 20;

  SmallDrive();  // undamaged: frames 100 ms apart, from 2011-09-26 13:10:51

  std::filesystem::path folder() const { return day() / "2011_09_26_drive_0099_sync"; }
  std::filesystem::path day() const { return temporary_.path(); }

  std::string read(const std::string& file) const;  // relative to folder()
  void write(const std::string& file, const std::string& content) const;
  void write_line(const std::string& file, std::size_t line, const std::string& content) const;
  void remove(const std::string& file) const;

 private:
  maploop::testing::TemporaryFolder temporary_;
};

// Returns a row of a real drive: 30 columns.
std::string oxts_row_text();

// These are the calibration of 2011-09-26, with rectified cameras and 32 x 24 pixels.
std::string cam_to_cam_text();
std::string velo_to_cam_text();
std::string imu_to_velo_text();

// Returns everything that a source delivers.
template <class T>
std::vector<T> read_all(Source<T>& source) {
  std::vector<T> samples;
  for (T sample; source.next(sample);) samples.push_back(sample);
  return samples;
}
template <class T>
std::vector<T> read_all(const std::unique_ptr<Source<T>>& source) {
  return read_all(*source);
}

template <class T>
std::vector<std::uint64_t> sequences(const std::vector<T>& samples) {
  std::vector<std::uint64_t> result;
  for (const T& sample : samples) result.push_back(sample.sequence);
  return result;
}

}  // namespace maploop::sensors
