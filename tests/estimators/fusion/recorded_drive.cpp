#include "tests/estimators/fusion/recorded_drive.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "msgs/frames.h"
#include "sensors/replay/files.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/support/drawn.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::testing {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// KITTI's rates and accelerations are older than the stamps of their rows by this time, s.
constexpr double inertial_delay = 0.060;
constexpr double odometry_latency = 0.060;

// Reads a table with a header and returns its columns by name.
class Table {
 public:
  explicit Table(const std::filesystem::path& path) {
    std::string text = sensors::read_text(path);
    std::istringstream header(text.substr(0, text.find('\n')));
    for (std::string name; std::getline(header, name, ',');) {
      const std::size_t column = columns_.size();
      columns_[name] = column;
    }
    std::replace(text.begin(), text.end(), ',', ' ');
    const std::vector<std::string_view> lines = sensors::split_lines(text);
    for (std::size_t i = 1; i < lines.size(); ++i)
      rows_.push_back(sensors::parse_numbers(lines[i]));
  }
  std::size_t size() const { return rows_.size(); }
  double operator()(std::size_t row, const std::string& column) const {
    return rows_.at(row).at(columns_.at(column));
  }

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<double>> rows_;
};

nlohmann::json meta_of(const std::filesystem::path& folder, const std::string& name) {
  return nlohmann::json::parse(sensors::read_text(folder / "tracks" / (name + ".meta.json")));
}

Isometry3d camera_of(const nlohmann::json& meta) {
  Isometry3d T_body_cam = Isometry3d::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      T_body_cam.matrix()(i, j) =
          meta["T_imu_cam"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return T_body_cam;
}

void add_sample(RecordedDrive& drive, const Table& imu, std::size_t row, const char* time) {
  ImuSample s;
  s.stamp = SyntheticDrive::at(imu(row, time) - inertial_delay);
  s.available = s.stamp + from_seconds(inertial_delay);
  s.sequence = row;
  s.specific_force_forward = imu(row, "ax");
  s.specific_force_left = imu(row, "ay");
  s.yaw_rate = imu(row, "wz");
  drive.imu.push_back(s);
}

// Adds a frame with the true pose, and the motion to it from the frame before if there is one.
void add_frame(RecordedDrive& drive, Time stamp, const Isometry3d& truth,
               const evaluation::Trajectory& cameras, std::size_t frame,
               const Isometry3d& T_body_cam, const OdometrySigmas& sigmas) {
  drive.stamps.push_back(stamp);
  drive.truth.push_back(truth);
  if (drive.stamps.size() < 2) return;
  const Isometry3d T =
      T_body_cam * (cameras[frame - 1].inverse() * cameras[frame]) * T_body_cam.inverse();
  RelativeMotion m;
  m.status = OdometryStatus::ok;
  m.from = drive.stamps[drive.stamps.size() - 2];
  m.stamp = stamp;
  m.available = stamp + from_seconds(odometry_latency);
  m.sequence = frame;
  m.translation = T.translation();
  m.rotation = Eigen::Quaterniond(T.linear()).normalized();
  const double translation_sigma = sigmas.speed * to_seconds(stamp - m.from);
  m.covariance.diagonal().head<3>().setConstant(translation_sigma * translation_sigma);
  m.covariance.diagonal().tail<3>().setConstant(sigmas.rotation * sigmas.rotation);
  drive.odometry.push_back(m);
}

// Returns a fix with errors of 0.5 m and 0.05 m/s at the truth's first stamp.
GnssFix noisy_start(const RecordedDrive& drive, const Vector3d& velocity, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return maploop::testing::drawn<Vector3d>([&] { return sigma * normal(random); });
  };
  GnssFix fix;
  fix.stamp = fix.available = fix.velocity_stamp = drive.stamps.front();
  fix.position =
      LocalFrame(test_origin()).to_geodetic(drive.truth.front().translation() + noise(0.5));
  fix.position_covariance = 0.25 * Eigen::Matrix3d::Identity();
  fix.velocity_enu = velocity + noise(0.05);
  fix.velocity_covariance = 0.0025 * Eigen::Matrix3d::Identity();
  return fix;
}

// Returns the velocity at the first stamp from the parabola through the first three positions.
Vector3d first_velocity(const RecordedDrive& drive) {
  const double t1 = to_seconds(drive.stamps[1] - drive.stamps[0]);
  const double t2 = to_seconds(drive.stamps[2] - drive.stamps[0]);
  const Vector3d step1 = drive.truth[1].translation() - drive.truth[0].translation();
  const Vector3d step2 = drive.truth[2].translation() - drive.truth[0].translation();
  return (t2 / t1 * step1 - t1 / t2 * step2) / (t2 - t1);
}

// Returns the rotation that levels the body of the first row, from its own accelerations: levelled
// = R body.
Eigen::Matrix3d level_of_first_row(const Table& imu) {
  const Vector3d body(imu(0, "ax"), imu(0, "ay"), imu(0, "az"));
  const Vector3d level(imu(0, "af"), imu(0, "al"), imu(0, "au"));
  // The roll follows from al = ay cos r - az sin r, then the pitch (nose up here) from af = ax cos
  // p + ... .
  const double roll = std::asin(body.y() / std::hypot(body.y(), body.z())) -
                      std::asin(level.y() / std::hypot(body.y(), body.z()));
  const Vector3d rolled = Eigen::AngleAxisd(roll, Vector3d::UnitX()) * body;
  const double down = std::atan2(level.x(), level.z()) - std::atan2(rolled.x(), rolled.z());
  return (Eigen::AngleAxisd(down, Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

RecordedDrive load_track_drive(const std::filesystem::path& data, const std::string& name,
                               const OdometrySigmas& sigmas, unsigned seed) {
  const auto folder = data / "kitti_odometry";
  const auto file = [&](const std::string& suffix) { return folder / "tracks" / (name + suffix); };
  const nlohmann::json meta = meta_of(folder, name);
  const Table imu(file(".imu.csv.gz"));
  const evaluation::Trajectory truth = evaluation::read_trajectory(file(".truth.csv.gz")).poses;
  const evaluation::Trajectory vo = evaluation::read_kitti_poses(file(".vo_baseline.txt.gz"));
  const Isometry3d T_body_cam = camera_of(meta);

  RecordedDrive drive;
  drive.name = name;
  for (std::size_t i = 0; i < imu.size(); ++i) add_sample(drive, imu, i, "t_oxts");
  const Isometry3d level(level_of_first_row(imu));
  // The recorder invented the first rows of sequence 06. The motorway tracks are good up to frame
  // 199 only.
  const std::size_t first =
      name == "2011_09_30_drive_0020" ? 20 : std::size_t(meta["first_good_frame"]);
  const std::size_t end = name == "2011_10_03_drive_0042" ? 200 : vo.size();
  for (std::size_t i = first; i < end; ++i) {
    add_frame(drive, SyntheticDrive::at(meta["timestamps"][i]),
              level * T_body_cam * truth[i] * T_body_cam.inverse(), vo, i, T_body_cam, sigmas);
  }
  drive.start = noisy_start(drive, first_velocity(drive), seed);
  return drive;
}

RecordedDrive load_sequence_00(const std::filesystem::path& data, const OdometrySigmas& sigmas,
                               unsigned seed) {
  const std::filesystem::path folder = data / "kitti_odometry";
  const Table imu(folder / "imu100/2011_10_03_0027.csv.gz");
  const Table truth(folder / "imu100/2011_10_03_0027.truth.csv.gz");
  const evaluation::Trajectory vo =
      evaluation::read_kitti_poses(folder / "peers/00_SPTAM_evo.txt.gz");
  std::istringstream text(sensors::read_text(folder / "poses/00.times.txt"));
  const std::vector<double> times(std::istream_iterator<double>(text), {});
  // The left camera's pose in the body frame is KITTI's calibration of 2011-10-03.
  const Isometry3d T_body_cam = camera_of(meta_of(folder, "2011_10_03_drive_0042"));

  RecordedDrive drive;
  drive.name = "sequence 00";
  for (std::size_t i = 0; i < imu.size(); ++i) {
    if (imu(i, "interpolated") == 0.0) add_sample(drive, imu, i, "t");
  }

  const LocalFrame frame(test_origin());
  const auto truth_pose = [&](std::size_t i) {
    const Geodetic g{radians(truth(i, "lat")), radians(truth(i, "lon")), truth(i, "alt")};
    // KITTI's pitch is positive nose down, its roll right side down.
    const Attitude a{azimuth_from_yaw(truth(i, "yaw")), -truth(i, "pitch"), truth(i, "roll")};
    return std::pair(frame.to_enu(g), Eigen::Quaterniond(rotation_enu_body(a)));
  };
  constexpr std::size_t first = 20;  // earlier frames are in invented rows
  std::size_t row = 0;
  for (std::size_t i = first; i < vo.size(); ++i) {
    while (row + 2 < truth.size() && truth(row + 1, "t") <= times[i]) ++row;
    const auto [p0, q0] = truth_pose(row);
    const auto [p1, q1] = truth_pose(row + 1);
    const double w = (times[i] - truth(row, "t")) / (truth(row + 1, "t") - truth(row, "t"));
    const Isometry3d pose = Eigen::Translation3d(p0 + w * (p1 - p0)) * q0.slerp(w, q1);
    add_frame(drive, SyntheticDrive::at(times[i]), pose, vo, i, T_body_cam, sigmas);
  }
  drive.start = noisy_start(drive, first_velocity(drive), seed);
  return drive;
}

}  // namespace maploop::testing
