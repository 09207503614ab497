// Recorded drives with labels of the links driven, and the errors of a receiver in a street that
// experiments add to them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/match/match_score.h"

namespace maploop::match {

struct RecordedDrive {
  std::string name;
  Track track;
  Labels labels;
};

// Reads FOLDER/oxts/NAME.csv.gz and FOLDER/labels/NAME.csv.gz. Throws std::runtime_error naming the
// file.
RecordedDrive read_recorded_drive(const std::filesystem::path& folder, const std::string& name);

struct TrackNoise {
  double white = 0.0;         // m on each axis, independent from fix to fix
  double markov = 0.0;        // m on each axis, first-order Gauss-Markov
  double markov_time = 30.0;  // s
  double speed = 0.0;         // m/s
  double azimuth = 0.0;       // rad
  std::uint64_t seed = 1;
};

struct NoisyTrack {
  Track track;
  std::vector<std::size_t> rows;  // row number in the drive, for each fix
};

// Returns the first row of each period of `interval` seconds that has one (0: all rows), with
// errors added to the values and their variances to the covariance.
NoisyTrack with_noise(const Track& track, double interval, const TrackNoise& noise);

struct InputCondition {
  std::string name;
  double interval;  // s between fixes; 0: all rows
  TrackNoise noise;

  // Returns the drive with these errors: once for each seed from 1 to `seeds`; only once without
  // noise.
  std::vector<NoisyTrack> realizations(const RecordedDrive& drive, int seeds) const;
};

// Returns the conditions without noise, and with white or Gauss-Markov noise of 5, 10 and 15 m;
// each at 1 and 10 Hz.
std::vector<InputCondition> input_conditions();

}  // namespace maploop::match
