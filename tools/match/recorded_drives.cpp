#include "tools/match/recorded_drives.h"

#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/csv_track.h"

namespace maploop::match {

RecordedDrive read_recorded_drive(const std::filesystem::path& folder, const std::string& name) {
  const auto track = folder / "oxts" / (name + ".csv.gz");
  return {name, parse_csv_track(evaluation::read_text(track), track.string(), {}),
          read_labels(folder / "labels" / (name + ".csv.gz"))};
}

const std::vector<InputCondition>& input_conditions() {
  const auto noisy = [](double white, double markov) {
    return TrackNoise{white, markov, 30.0, 0.2, radians(3.0), 1};
  };
  static const std::vector<InputCondition> all{
      {"noise-free, 1 Hz", 1.0, {}},
      {"noise-free, 10 Hz", 0.0, {}},
      {"white 5 m, 1 Hz", 1.0, noisy(5, 0)},
      {"white 10 m, 1 Hz", 1.0, noisy(10, 0)},
      {"white 15 m, 1 Hz", 1.0, noisy(15, 0)},
      {"white 5 m, 10 Hz", 0.0, noisy(5, 0)},
      {"white 10 m, 10 Hz", 0.0, noisy(10, 0)},
      {"white 15 m, 10 Hz", 0.0, noisy(15, 0)},
      {"Gauss-Markov 5 m, 1 Hz", 1.0, noisy(0, 5)},
      {"Gauss-Markov 10 m, 1 Hz", 1.0, noisy(0, 10)},
      {"Gauss-Markov 15 m, 1 Hz", 1.0, noisy(0, 15)},
      {"Gauss-Markov 5 m, 10 Hz", 0.0, noisy(0, 5)},
      {"Gauss-Markov 10 m, 10 Hz", 0.0, noisy(0, 10)},
      {"Gauss-Markov 15 m, 10 Hz", 0.0, noisy(0, 15)},
  };
  return all;
}

NoisyTrack noisy_track(const RecordedDrive& drive, const InputCondition& condition, int seed) {
  TrackNoise noise = condition.noise;
  noise.seed = static_cast<std::uint64_t>(seed);
  NoisyTrack noisy;
  noisy.track = with_noise(drive.track, condition.interval, noise, &noisy.rows);
  return noisy;
}

}  // namespace maploop::match
