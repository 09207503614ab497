#include "tests/estimators/fusion/recorded_drive.h"

#include <zlib.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <stdexcept>

#include "msgs/frames.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::testing {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// KITTI's rates and accelerations are older than the stamps of their rows by this time, s.
constexpr double inertial_delay = 0.060;
constexpr double odometry_latency = 0.060;

std::string read_gzip(const std::filesystem::path& path) {
  const gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error("cannot read " + path.string());
  std::string text;
  std::array<char, 65536> buffer{};
  int got = 0;
  while ((got = gzread(file, buffer.data(), buffer.size())) > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
  gzclose(file);
  if (got < 0) throw std::runtime_error("damaged gzip file " + path.string());
  return text;
}

std::vector<double> numbers(std::string line) {
  for (char& c : line) {
    if (c == ',') c = ' ';
  }
  std::istringstream in(line);
  std::vector<double> row;
  for (double v = 0.0; in >> v;) row.push_back(v);
  return row;
}

std::vector<std::vector<double>> rows(const std::filesystem::path& path) {
  std::istringstream in(read_gzip(path));
  std::vector<std::vector<double>> result;
  for (std::string line; std::getline(in, line);) {
    if (std::vector<double> row = numbers(line); !row.empty()) result.push_back(row);
  }
  return result;
}

// Reads a table with a header and returns its columns by name.
class Table {
 public:
  explicit Table(const std::filesystem::path& path) {
    std::istringstream in(read_gzip(path));
    std::string line;
    std::getline(in, line);
    std::istringstream header(line);
    for (std::string name; std::getline(header, name, ',');) {
      const std::size_t column = columns_.size();
      columns_[name] = column;
    }
    while (std::getline(in, line)) rows_.push_back(numbers(line));
  }
  std::size_t size() const { return rows_.size(); }
  double operator()(std::size_t row, const std::string& column) const {
    return rows_.at(row).at(columns_.at(column));
  }

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<double>> rows_;
};

// Converts KITTI's twelve numbers, row by row; a thirteenth before them is the frame.
Isometry3d pose_of(const std::vector<double>& row) {
  const std::size_t first = row.size() - 12;
  Isometry3d T = Isometry3d::Identity();
  for (std::size_t i = 0; i < 12; ++i) {
    T.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = row[first + i];
  }
  return T;
}

RelativeMotion motion(const Isometry3d& T, Time from, Time to, const OdometrySigmas& sigmas,
                      std::uint64_t sequence) {
  RelativeMotion m;
  m.status = OdometryStatus::ok;
  m.from = from;
  m.stamp = to;
  m.available = to + from_seconds(odometry_latency);
  m.sequence = sequence;
  m.translation = T.translation();
  m.rotation = Eigen::Quaterniond(T.linear()).normalized();
  const double translation_sigma = sigmas.speed * to_seconds(to - from);
  m.covariance.diagonal().head<3>().setConstant(translation_sigma * translation_sigma);
  m.covariance.diagonal().tail<3>().setConstant(sigmas.rotation * sigmas.rotation);
  return m;
}

// Returns a fix with errors of 0.5 m and 0.05 m/s at the truth's first stamp.
GnssFix noisy_start(const RecordedDrive& drive, const Vector3d& velocity, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return Vector3d(sigma * normal(random), sigma * normal(random), sigma * normal(random));
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
  const auto file = [&](const std::string& suffix) {
    return data / "kitti_odometry/tracks" / (name + suffix);
  };
  std::ifstream meta_file(file(".meta.json"));
  const nlohmann::json meta = nlohmann::json::parse(meta_file);
  const Table imu(file(".imu.csv.gz"));
  const Table truth(file(".truth.csv.gz"));
  const std::vector<std::vector<double>> vo = rows(file(".vo_baseline.txt.gz"));
  Isometry3d T_body_cam = Isometry3d::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      T_body_cam.matrix()(i, j) =
          meta["T_imu_cam"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }

  RecordedDrive drive;
  drive.name = name;
  for (std::size_t i = 0; i < imu.size(); ++i) {
    ImuSample s;
    s.stamp = SyntheticDrive::at(imu(i, "t_oxts") - inertial_delay);
    s.available = s.stamp + from_seconds(inertial_delay);
    s.sequence = i;
    s.specific_force_forward = imu(i, "ax");
    s.specific_force_left = imu(i, "ay");
    s.yaw_rate = imu(i, "wz");
    drive.imu.push_back(s);
  }
  const Isometry3d level(level_of_first_row(imu));
  // The recorder invented the first rows of sequence 06. The motorway tracks are good up to frame
  // 199 only.
  const std::size_t first =
      name == "2011_09_30_drive_0020" ? 20 : std::size_t(meta["first_good_frame"]);
  const std::size_t end = name == "2011_10_03_drive_0042" ? 200 : vo.size();
  const auto stamp = [&](std::size_t i) { return SyntheticDrive::at(meta["timestamps"][i]); };
  for (std::size_t i = first; i < end; ++i) {
    const Eigen::Quaterniond q(truth(i, "cam_qw"), truth(i, "cam_qx"), truth(i, "cam_qy"),
                               truth(i, "cam_qz"));
    const Isometry3d T_cam0_cam =
        Eigen::Translation3d(truth(i, "cam_x"), truth(i, "cam_y"), truth(i, "cam_z")) *
        q.normalized();
    drive.stamps.push_back(stamp(i));
    drive.truth.push_back(level * T_body_cam * T_cam0_cam * T_body_cam.inverse());
    if (i == first) continue;
    const Isometry3d T_cam = pose_of(vo[i - 1]).inverse() * pose_of(vo[i]);
    drive.odometry.push_back(
        motion(T_body_cam * T_cam * T_body_cam.inverse(), stamp(i - 1), stamp(i), sigmas, i));
  }
  drive.start = noisy_start(drive, first_velocity(drive), seed);
  return drive;
}

RecordedDrive load_sequence_00(const std::filesystem::path& data, const OdometrySigmas& sigmas,
                               unsigned seed) {
  const std::filesystem::path folder = data / "kitti_odometry";
  const Table imu(folder / "imu100/2011_10_03_0027.csv.gz");
  const Table truth(folder / "imu100/2011_10_03_0027.truth.csv.gz");
  const std::vector<std::vector<double>> vo = rows(folder / "peers/00_SPTAM_evo.txt.gz");
  const std::vector<std::vector<double>> times = rows(folder / "poses/00.times.txt");
  // The left camera's pose in the body frame is KITTI's calibration of 2011-10-03.
  Isometry3d T_body_cam = Isometry3d::Identity();
  {
    std::ifstream meta_file(folder / "tracks/2011_10_03_drive_0042.meta.json");
    const nlohmann::json meta = nlohmann::json::parse(meta_file);
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        T_body_cam.matrix()(i, j) =
            meta["T_imu_cam"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      }
    }
  }

  RecordedDrive drive;
  drive.name = "sequence 00";
  for (std::size_t i = 0; i < imu.size(); ++i) {
    if (imu(i, "interpolated") != 0.0) continue;
    ImuSample s;
    s.stamp = SyntheticDrive::at(imu(i, "t") - inertial_delay);
    s.available = s.stamp + from_seconds(inertial_delay);
    s.sequence = i;
    s.specific_force_forward = imu(i, "ax");
    s.specific_force_left = imu(i, "ay");
    s.yaw_rate = imu(i, "wz");
    drive.imu.push_back(s);
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
    const double t = times[i][0];
    while (row + 2 < truth.size() && truth(row + 1, "t") <= t) ++row;
    const auto [p0, q0] = truth_pose(row);
    const auto [p1, q1] = truth_pose(row + 1);
    const double w = (t - truth(row, "t")) / (truth(row + 1, "t") - truth(row, "t"));
    drive.stamps.push_back(SyntheticDrive::at(t));
    drive.truth.push_back(Eigen::Translation3d(p0 + w * (p1 - p0)) * q0.slerp(w, q1));
    if (i == first) continue;
    const Isometry3d T_cam = pose_of(vo[i - 1]).inverse() * pose_of(vo[i]);
    drive.odometry.push_back(motion(T_body_cam * T_cam * T_body_cam.inverse(),
                                    SyntheticDrive::at(times[i - 1][0]), SyntheticDrive::at(t),
                                    sigmas, i));
  }
  drive.start = noisy_start(drive, first_velocity(drive), seed);
  return drive;
}

}  // namespace maploop::testing
