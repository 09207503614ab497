#include "tools/doctor/recording_health.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace maploop::tools {
namespace {

// Returns the value below which that share of them is; 0 if there are none.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

bool repeats(const Sample&, const Sample&) {
  return false;
}

bool repeats(const ImuSample& a, const ImuSample& b) {
  return a.values() == b.values();
}

template <class T>
std::optional<SensorHealth> examine_sensor(const char* name,
                                           const std::unique_ptr<sensors::Source<T>>& source,
                                           const vehicle::Recording& recording,
                                           const ExamineProgress& progress) {
  if (source == nullptr) return std::nullopt;
  const Time first = recording.first_stamp;
  const double part = std::max(to_seconds(recording.last_stamp - first), 1e-3) / SampleTimes::parts;
  SensorHealth health;
  health.name = name;
  std::vector<double> periods, delays;
  T sample, previous;
  while (source->next(sample)) {
    progress(name, sample.stamp);
    if (health.samples++ > 0) {
      const double period = to_seconds(sample.stamp - previous.stamp);
      if (period > health.longest_gap) {
        health.longest_gap = period;
        health.gap_at = to_seconds(previous.stamp - first);
      }
      periods.push_back(period);
      health.repeated += repeats(sample, previous) ? 1 : 0;
    }
    delays.push_back(1e3 * to_seconds(sample.available - sample.stamp));
    const double at = to_seconds(sample.stamp - first) / part;
    if (at >= 0.0 && at < SampleTimes::parts) {
      const auto i = static_cast<std::size_t>(at);
      ++health.times.samples[i];
      health.times.delay[i] = std::max(health.times.delay[i], delays.back());
    }
    std::swap(sample, previous);
  }
  const double median = quantile(periods, 0.5);
  health.rate = median > 0.0 ? 1.0 / median : 0.0;
  for (double& period : periods) period = 1e3 * std::abs(period - median);
  health.jitter = quantile(std::move(periods), 0.9);
  health.delay = quantile(std::move(delays), 0.5);
  health.left_out = source->report().refused;
  health.finding = source->report().main_reason();
  return health;
}

const SensorHealth* find(const std::vector<SensorHealth>& sensors, std::string_view name) {
  const auto found = std::ranges::find(sensors, name, &SensorHealth::name);
  return found == sensors.end() || found->samples == 0 ? nullptr : &*found;
}

void add_findings(const SensorHealth& s, std::vector<std::string>& sentences) {
  if (s.samples == 0) {
    sentences.push_back("There is no sample of " + s.name + " that can be used" +
                        (s.finding.empty() ? "." : ": " + s.finding + "."));
    return;
  }
  if (s.left_out > 0) {
    sentences.push_back(fmt::format("{} of {} of {} were left out, most because: {}.", s.left_out,
                                    s.samples + s.left_out, s.name, s.finding));
  }
  constexpr double many_periods = 5.0;
  if (s.longest_gap * s.rate > many_periods) {
    sentences.push_back(
        fmt::format("{} pauses for {:.2f} s at {:.1f} s.", s.name, s.longest_gap, s.gap_at));
  }
  if (s.repeated > 0) {
    sentences.push_back(
        fmt::format("{} samples of {} repeat the values of the one before: a frozen "
                    "sensor, or a slow one that is recorded too often.",
                    s.repeated, s.name));
  }
}

}  // namespace

const web::Columns<SensorHealth> sensor_health_columns{
    {"sensor", "sensor", -10, 0, &SensorHealth::name},
    {"samples", "samples", 9, 0, &SensorHealth::samples},
    {"left_out", "left out", 9, 0, &SensorHealth::left_out},
    {"rate_hz", "rate, Hz", 9, 1, &SensorHealth::rate},
    {"jitter_ms", "jitter, ms", 11, 1, &SensorHealth::jitter},
    {"longest_gap_s", "longest gap, s", 15, 3, &SensorHealth::longest_gap},
    {"gap_at_s", "at, s", 9, 1, &SensorHealth::gap_at},
    {"delay_ms", "delay, ms", 10, 1, &SensorHealth::delay},
    {"repeated", "repeated", 9, 0, &SensorHealth::repeated},
    {"finding", "", 0, 0, &SensorHealth::finding},
};

std::vector<SensorHealth> examine(const vehicle::Recording& recording,
                                  const ExamineProgress& progress) {
  const vehicle::Sensors s = recording.sensors(Time::max());
  std::vector<SensorHealth> all;
  const auto add = [&](const char* name, const auto& source) {
    if (auto health = examine_sensor(name, source, recording, progress))
      all.push_back(std::move(*health));
  };
  add("camera", s.camera);
  add("lidar", s.velodyne);
  add("imu", s.imu);
  add("gnss", s.gnss);
  add("epochs", s.epochs);
  add("wheel", s.wheel);
  add("odometry", s.odometry);
  add("reference", s.reference);
  return all;
}

std::vector<std::string> advice(const std::vector<SensorHealth>& sensors, const std::string& path) {
  std::vector<std::string> sentences;
  for (const SensorHealth& s : sensors) add_findings(s, sentences);
  const bool lidar = find(sensors, "lidar") != nullptr;
  if (find(sensors, "gnss") == nullptr && find(sensors, "epochs") == nullptr) {
    const std::string command = ": maploop odometry " + path;
    std::string sentence = "No GNSS gives a position to start from, so that a replay has none.";
    if (find(sensors, "camera") != nullptr)
      sentence += " The path of the cameras" + command + " --tum path.tum";
    if (lidar) sentence += " The path of the LiDAR alone" + command + " --lidar --tum path.tum";
    sentences.push_back(std::move(sentence));
    return sentences;
  }
  std::string used;
  for (const char* name : {"camera", "lidar", "odometry", "imu", "wheel", "gnss", "epochs"})
    if (find(sensors, name) != nullptr) used += (used.empty() ? "" : ", ") + std::string(name);
  sentences.push_back("A replay can combine " + used + ".");
  if (std::ranges::find(sensors, "imu", &SensorHealth::name) == sensors.end())
    sentences.push_back("There is no inertial unit: between the fixes only odometry carries on.");
  if (find(sensors, "reference") == nullptr)
    sentences.push_back("There is no reference, so that a replay is not scored.");
  sentences.push_back("Next: maploop replay " + path + " --report drive.html");
  return sentences;
}

}  // namespace maploop::tools
