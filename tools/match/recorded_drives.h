// Reads recorded drives with labels of the links driven, and adds the errors of experiments to
// them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/match/labels.h"
#include "tools/match/track.h"
#include "tools/match/track_noise.h"

namespace maploop::match {

struct RecordedDrive {
  std::string name;
  Track track;
  std::map<std::size_t, Label> labels;  // by row number of the track
};

// Reads FOLDER/oxts/NAME.csv.gz and FOLDER/labels/NAME.csv.gz. Throws std::runtime_error naming the
// file.
RecordedDrive read_recorded_drive(const std::filesystem::path& folder, const std::string& name);

struct InputCondition {
  const char* name;
  double interval;  // s between fixes; 0: all rows
  TrackNoise noise;

  bool noisy() const { return noise.white + noise.markov > 0.0; }
  // Returns how many of `seeds` realizations differ: without noise only one.
  int realizations(int seeds) const { return noisy() ? seeds : 1; }
};

struct NoisyTrack {
  Track track;
  std::vector<std::size_t> rows;  // row number in the drive, for each fix
};
NoisyTrack noisy_track(const RecordedDrive& drive, const InputCondition& condition, int seed);

// Returns the conditions without noise, and with white or Gauss-Markov noise of 5, 10 and 15 m;
// each at 1 and 10 Hz.
const std::vector<InputCondition>& input_conditions();

}  // namespace maploop::match
