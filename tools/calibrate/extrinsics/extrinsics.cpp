#include "tools/calibrate/extrinsics/extrinsics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "msgs/frames.h"
#include "tools/calibrate/extrinsics/edge_alignment.h"
#include "tools/calibrate/extrinsics/found_values.h"
#include "tools/calibrate/extrinsics/ground_alignment.h"

namespace maploop::extrinsics {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr double compared = 0.09;  // s, least duration of the motions whose rates are compared
constexpr double mounted_sigma = 0.005;  // rad, of x along the travel: [fusion] slip_sigma

double mean_speed(const std::vector<SensorMotion>& motions) {
  double way = 0.0, time = 1e-9;  // m, s
  for (const SensorMotion& m : motions) {
    way += m.T_from_to.translation().norm();
    time += to_seconds(m.to - m.from);
  }
  return way / time;
}

using Aligned = std::optional<RateAlignment>;

// These are the alignments of the pairs of sensors that succeeded.
class Search {
 public:
  Search(const Measurements& measured, const VehicleDescription& described)
      : measured_(measured), car_(described.car), described_(described), found_(described) {
    const auto& [car, camera, lidar, imu, antenna] = described;
    start_.R_body_camera = camera_pose(camera.position, camera.rotation).linear();
    start_.R_body_lidar = sensor_pose(lidar.position, lidar.rotation).linear();
    rotations_ = start_;
  }

  Extrinsics result() && {
    pair_sensors();
    find_delays();
    if (both_) refine_by_views();
    join_rotations();
    find_positions();
    if (measured_.inertial.mount) found_.set_mount(*measured_.inertial.mount);
    return found_.take();
  }

 private:
  Aligned align_pair(const char* a_name, const RotationStream& a, const char* b_name,
                     const SensorMotions& b, const Matrix3d& R_a_b, double bias_sigma) {
    AlignmentStart start;
    start.R_a_b = R_a_b;
    start.bias_sigma = bias_sigma;
    start.delay_by_third_axis = &b == &measured_.lidar;
    const RateAlignment r = align(a, joined(b.motions, compared), start);
    found_.add({a_name, b_name, r});
    return r.status == AlignmentStatus::ok ? Aligned(r) : std::nullopt;
  }

  void pair_sensors() {
    const InertialRates& rates = measured_.inertial;
    const CameraMotions& camera = measured_.camera;
    const LidarMotions& lidar = measured_.lidar;
    if (!rates.samples.empty()) {
      const RotationStream unit = RotationStream::of_rates(rates.samples, rates.vertical_alone);
      const double bias = AlignmentStart().bias_sigma;
      if (camera.samples > 0)
        camera_ = align_pair("inertial unit", unit, "camera", camera, start_.R_body_camera, bias);
      if (lidar.samples > 0)
        lidar_ = align_pair("inertial unit", unit, "LiDAR", lidar, start_.R_body_lidar, bias);
      if (rates.vertical_alone && (camera_ || lidar_)) {
        found_.say(
            "The unit has one gyro: about its vertical axis the other sensors' rotation is not "
            "observable by it, and yaw is that of the direction of travel alone.");
      }
    }
    if (camera.samples == 0 || lidar.samples == 0) return;
    both_ = align_pair("camera", RotationStream::of_motions(camera.motions), "LiDAR", lidar,
                       start_.R_body_camera.transpose() * start_.R_body_lidar, 0.0);
    if (!both_) return;
    eye_ = hand_eye(camera.motions, lidar.motions, *both_);
  }

  // Refines the LiDAR's pose against the camera by what both see, where turns do not show the place
  // beginning at the one that is described.
  void refine_by_views() {
    const CameraMotions& camera = measured_.camera;
    const LidarMotions& lidar = measured_.lidar;
    const std::vector<ViewPair> views =
        pair_views(camera.views, lidar.views, lidar.motions, -lidar_delay_);
    const auto& [car, by_camera, by_lidar, imu, antenna] = described_;
    const Vector3d described = (camera_pose(by_camera.position, by_camera.rotation).inverse() *
                                sensor_pose(by_lidar.position, by_lidar.rotation))
                                   .translation();
    HandEye start = eye_;
    for (int i = 0; i < 3; ++i) {
      if (eye_.position_sigma[i] > observed_position) start.T_a_b.translation()[i] = described[i];
    }
    for (int round = 0; round < 3; ++round) {  // each takes the other's part as it is
      if (const auto found = align_ground(views, camera.calibration, start)) start = eye_ = *found;
      if (const auto found = align_edges(views, camera.calibration, start)) start = eye_ = *found;
    }
    eye_.position_sigma.z() =
        std::hypot(eye_.position_sigma.z(), lidar_delay_sigma_ * mean_speed(lidar.motions));
    found_.set_camera_lidar(eye_);
  }

  void join_rotations() {
    std::vector<MeasuredRotation> all;
    for (const auto& [part, aligned] :
         {std::pair(Part::camera, &camera_), {Part::lidar, &lidar_}}) {
      if (!*aligned) continue;
      all.push_back(
          {Part::body, part, (*aligned)->R_a_b, (*aligned)->covariance.topLeftCorner<3, 3>()});
    }
    if (both_)
      all.push_back({Part::camera, Part::lidar, eye_.T_a_b.linear(), eye_.rotation_covariance});
    // Without gyros the LiDAR is found from where the camera is described to be.
    if (both_ && !camera_ && !lidar_)
      all.push_back({Part::body, Part::camera, start_.R_body_camera, camera_covariance()});
    if (all.empty()) return;
    rotations_ = join(all, travel(), start_);
    if (camera_ || (lidar_ && both_)) found_.set_camera_rotation(rotations_);
    if (lidar_ || both_) found_.set_lidar_rotation(rotations_);
  }

  Matrix3d camera_covariance() const {
    const SensorRotation& r = described_.camera.rotation;
    const Vector3d sigma(radians(r.roll_sigma), radians(r.pitch_sigma), radians(r.yaw_sigma));
    return sigma.cwiseAbs2().asDiagonal();
  }

  // The direction in which one of the sensors travels, in its own axes.
  std::optional<MeasuredTravel> travel() const {
    const Aligned& by = camera_ ? camera_ : lidar_;
    if (!by) return std::nullopt;
    const Travel t = travel_of(camera_ ? measured_.camera.motions : measured_.lidar.motions,
                               by->R_a_b, car_.rear_slip, car_.rear_slip_sigma);
    if (!t.found) return std::nullopt;
    return MeasuredTravel{camera_ ? Part::camera : Part::lidar,
                          Vector3d(1.0, 0.0, std::tan(car_.climb_offset)).normalized(),
                          by->R_a_b.transpose() * Vector3d(1.0, t.course, t.climb).normalized(),
                          std::hypot(t.course_sigma, mounted_sigma),
                          std::hypot(t.climb_sigma, car_.climb_offset_sigma)};
  }

  // Unknown are the delays of the unit and of the LiDAR against the camera's; without a camera,
  // that of the unit against the LiDAR's.
  void find_delays() {
    const bool of_lidar = both_ || (camera_ && lidar_);
    struct Measured {
      const Aligned& aligned;
      Eigen::Vector2d j;
    };
    const std::vector<Measured> all{
        {camera_, {1.0, 0.0}}, {lidar_, {1.0, of_lidar ? -1.0 : 0.0}}, {both_, {0.0, -1.0}}};
    Eigen::Matrix2d normal = 1e-6 * Eigen::Matrix2d::Identity();  // nothing is known before
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (const auto& [r, j] : all) {
      if (!r) continue;
      normal += j * j.transpose() / r->covariance(3, 3);
      gradient += r->delay / r->covariance(3, 3) * j;
    }
    const Eigen::Vector2d delays = normal.inverse() * gradient;
    double contradiction = 1.0;  // one is redundant if there are three
    if (camera_ && lidar_ && both_) {
      double squares = 0.0;
      for (const auto& [r, j] : all)
        squares += std::pow(r->delay - j.dot(delays), 2) / r->covariance(3, 3);
      contradiction = std::max(1.0, squares);
    }
    const Eigen::Vector2d sigma = (contradiction * normal.inverse().diagonal()).cwiseSqrt();
    std::vector<FoundValues::MoreDelay> found;
    if (camera_ || lidar_) found.push_back({"imu", delays[0], sigma[0]});
    if (of_lidar) {
      lidar_delay_ = delays[1];
      lidar_delay_sigma_ = sigma[1];
      found.push_back({"lidar", lidar_delay_, lidar_delay_sigma_});
    }
    found_.set_delays(camera_ || of_lidar ? "camera" : "lidar", found);
  }

  void find_positions() {
    const auto forward = [&](const SensorMotions& motions, const Matrix3d& R_body_sensor) {
      return travel_of(motions.motions, R_body_sensor, car_.rear_slip, car_.rear_slip_sigma);
    };
    if (camera_) found_.set_forward("camera", forward(measured_.camera, rotations_.R_body_camera));
    if (eye_.found) {
      found_.set_lidar_position(eye_, rotations_);
    } else if (lidar_) {
      found_.set_forward("lidar", forward(measured_.lidar, rotations_.R_body_lidar));
    }
  }

  const Measurements& measured_;
  CarDescription car_;
  VehicleDescription described_;
  FoundValues found_;
  JointRotation start_, rotations_;
  Aligned camera_, lidar_;                              // against the unit
  Aligned both_;                                        // the camera against the LiDAR
  double lidar_delay_ = 0.0, lidar_delay_sigma_ = 0.0;  // s, against the camera
  HandEye eye_;
};

}  // namespace

Measurements measure(const vehicle::Recording& recording, const vehicle::VehicleConfig& config,
                     const Stretch& stretch, const Progress& progress) {
  return {camera_motions(recording, config, stretch, progress),
          lidar_motions(recording, config, stretch, progress), inertial_rates(recording, stretch)};
}

Extrinsics find_extrinsics(const Measurements& measurements, const VehicleDescription& described) {
  return Search(measurements, described).result();
}

}  // namespace maploop::extrinsics
