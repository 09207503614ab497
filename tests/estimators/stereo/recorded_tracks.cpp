#include "tests/estimators/stereo/recorded_tracks.h"

#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

namespace maploop::testing {
namespace {

using Observations = std::vector<std::map<std::int64_t, stereo::StereoObservation>>;  // by frame

std::string read_gzip(const std::filesystem::path& file) {
  const gzFile stream = gzopen(file.c_str(), "rb");
  if (stream == nullptr) throw std::runtime_error(file.string() + ": cannot be read");
  std::string text;
  std::vector<char> buffer(1 << 16);
  int count = 0;
  while ((count = gzread(stream, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  gzclose(stream);
  if (count < 0) throw std::runtime_error(file.string() + ": damaged");
  return text;
}

// Rows of numbers; commas or blanks between; a heading is left out.
std::vector<std::vector<double>> read_table(const std::filesystem::path& file) {
  std::istringstream lines(read_gzip(file));
  std::vector<std::vector<double>> table;
  for (std::string line; std::getline(lines, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::vector<double> row;
    for (double value; fields >> value;) row.push_back(value);
    if (!row.empty()) table.push_back(row);
  }
  return table;
}

Eigen::Isometry3d pose_of(const Eigen::Vector3d& p, const Eigen::Quaterniond& q) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = p;
  return pose;
}

StereoCalibration calibration_of(const nlohmann::json& meta) {
  StereoCalibration calibration;
  calibration.width = 1242;
  calibration.height = 375;
  calibration.fx = meta.at("fx");
  calibration.fy = meta.at("fy");
  calibration.cx = meta.at("cu");
  calibration.cy = meta.at("cv");
  calibration.baseline = meta.at("baseline_m");
  return calibration;
}

}  // namespace

RecordedTracks read_recorded_tracks(const std::filesystem::path& folder, const std::string& drive) {
  std::ifstream meta_stream(folder / (drive + ".meta.json"));
  if (!meta_stream)
    throw std::runtime_error((folder / (drive + ".meta.json")).string() + ": cannot be read");
  const nlohmann::json meta = nlohmann::json::parse(meta_stream);
  const std::set<std::int64_t> suspect = meta.at("suspect_tracks").get<std::set<std::int64_t>>();
  const auto first = meta.at("first_good_frame").get<std::size_t>();
  const auto all_seconds = meta.at("timestamps").get<std::vector<double>>();

  RecordedTracks recorded;
  recorded.calibration = calibration_of(meta);
  Observations seen(all_seconds.size());
  for (const std::vector<double>& row : read_table(folder / (drive + ".csv.gz")))
    if (!suspect.contains(static_cast<std::int64_t>(row[1])))
      seen.at(static_cast<std::size_t>(row[0]))[static_cast<std::int64_t>(row[1])] = {
          row[2], row[3], row[4], row[5]};

  const auto truth = read_table(folder / (drive + ".truth.csv.gz"));
  const auto baseline = read_table(folder / (drive + ".vo_baseline.txt.gz"));
  for (std::size_t frame = first; frame < all_seconds.size(); ++frame) {
    recorded.seconds.push_back(all_seconds[frame]);
    const std::vector<double>& t = truth.at(frame);
    recorded.truth.push_back(pose_of({t[9], t[10], t[11]}, {t[12], t[13], t[14], t[15]}));
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> b(
        baseline.at(frame).data());
    recorded.baseline.push_back(
        pose_of(b.col(3), Eigen::Quaterniond(Eigen::Matrix3d(b.leftCols<3>()))));
    if (frame + 1 == all_seconds.size()) break;
    std::vector<stereo::StereoTrack>& pair = recorded.pairs.emplace_back();
    for (const auto& [id, now] : seen[frame])
      if (const auto next = seen[frame + 1].find(id); next != seen[frame + 1].end())
        pair.push_back({id, now, next->second});
  }
  return recorded;
}

}  // namespace maploop::testing
