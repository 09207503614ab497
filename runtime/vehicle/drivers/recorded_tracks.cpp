#include "runtime/vehicle/drivers/recorded_tracks.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "sensors/replay/files.h"

namespace maploop::vehicle {
namespace {

// The meta file does not contain the size of the images; this is KITTI's.
constexpr int image_width = 1242;
constexpr int image_height = 375;

Eigen::Isometry3d to_pose(const nlohmann::json& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose(row, column) =
          rows.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column));
    }
  }
  return pose;
}

StereoCalibration to_calibration(const nlohmann::json& meta) {
  StereoCalibration calibration;
  calibration.width = image_width;
  calibration.height = image_height;
  calibration.fx = meta.at("fx");
  calibration.fy = meta.at("fy");
  calibration.cx = meta.at("cu");
  calibration.cy = meta.at("cv");
  calibration.baseline = meta.at("baseline_m");
  if (meta.contains("T_imu_cam")) calibration.T_body_cam = to_pose(meta.at("T_imu_cam"));
  return calibration;
}

// Reads the six numbers of a line; returns false if the line is not six numbers.
bool parse(const std::string& line, std::array<double, 6>& row) {
  const char* at = line.data();
  const char* end = at + line.size();
  while (end > at && (end[-1] == '\r' || end[-1] == ' ')) --end;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return false;
    const auto [stop, error] = std::from_chars(at, end, row[i]);
    if (error != std::errc()) return false;
    at = stop;
  }
  return at == end;
}

void read_rows(const std::filesystem::path& file, const std::set<std::int64_t>& suspect,
               RecordedTracks* recorded) {
  std::istringstream lines(sensors::read_text(file));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || (number == 1 && line.starts_with("frame"))) continue;
    std::array<double, 6> row{};
    const bool numbers = parse(line, row);
    if (!numbers || !(row[0] >= 0.0 && row[0] < static_cast<double>(recorded->frames.size()))) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                               (numbers ? ": the frame has no timestamp in the .meta.json"
                                        : ": the columns must be frame,track,uL,vL,uR,vR"));
    }
    const auto id = static_cast<std::int64_t>(row[1]);
    if (!suspect.contains(id)) {
      recorded->frames[static_cast<std::size_t>(row[0])].push_back(
          {id, {row[2], row[3], row[4], row[5]}});
    }
  }
  for (auto& frame : recorded->frames)
    std::sort(frame.begin(), frame.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
}

}  // namespace

void RecordedTracks::add(std::size_t previous, std::size_t current,
                         std::span<const stereo::StereoTrack> tracks) {
  const auto by_id = [](const Seen& a, const Seen& b) { return a.id < b.id; };
  std::vector<Seen> before, now;
  for (const stereo::StereoTrack& track : tracks) {
    before.push_back({track.id, track.previous});
    now.push_back({track.id, track.current});
  }
  std::sort(before.begin(), before.end(), by_id);
  std::sort(now.begin(), now.end(), by_id);
  // Tracks that began before the previous frame are in it already.
  std::vector<Seen> joined;
  std::set_union(frames.at(previous).begin(), frames[previous].end(), before.begin(), before.end(),
                 std::back_inserter(joined), by_id);
  frames[previous].swap(joined);
  frames.at(current).swap(now);
}

std::vector<stereo::StereoTrack> RecordedTracks::between(std::size_t previous,
                                                         std::size_t current) const {
  std::vector<stereo::StereoTrack> tracks;
  auto next = frames.at(current).begin();
  for (const Seen& seen : frames.at(previous)) {
    while (next != frames[current].end() && next->id < seen.id) ++next;
    if (next != frames[current].end() && next->id == seen.id)
      tracks.push_back({seen.id, seen.at, next->at});
  }
  return tracks;
}

std::filesystem::path meta_beside(std::filesystem::path file) {
  if (file.extension() == ".gz") file.replace_extension();
  if (file.extension() != ".csv") {
    throw std::runtime_error(file.string() +
                             ": not the folder of a drive, and not recorded tracks, which are a "
                             ".csv or .csv.gz with its .meta.json");
  }
  return file.replace_extension(".meta.json");
}

RecordedTracks read_recorded_tracks(const std::filesystem::path& file) {
  const std::filesystem::path meta_file = meta_beside(file);
  RecordedTracks recorded;
  std::set<std::int64_t> suspect;
  try {
    const auto meta = nlohmann::json::parse(sensors::read_text(meta_file));
    recorded.calibration = to_calibration(meta);
    recorded.first_good_frame = meta.value("first_good_frame", std::size_t{0});
    suspect = meta.value("suspect_tracks", suspect);
    for (const double seconds : meta.at("timestamps").get<std::vector<double>>())
      recorded.stamps.push_back(Time(checked_seconds(seconds)));
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(meta_file.string() + ": " + e.what());
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(meta_file.string() + ": " + e.what());
  }
  recorded.frames.resize(recorded.stamps.size());
  read_rows(file, suspect, &recorded);
  return recorded;
}

stereo::StereoParameters for_recorded_tracks(stereo::StereoParameters parameters) {
  parameters.min_tracks = 6;
  parameters.min_inliers = 6;
  parameters.min_disparity = 0.5;
  parameters.max_row_error = 1.5;
  parameters.sigma_track = 0.3;
  parameters.sigma_disparity = 0.3;
  return parameters;
}

}  // namespace maploop::vehicle
