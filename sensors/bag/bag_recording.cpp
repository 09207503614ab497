#include "sensors/bag/bag_recording.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "msgs/frames.h"
#include "msgs/input_limits.h"
#include "sensors/bag/bag_sources.h"
#include "sensors/bag/body_frame.h"
#include "sensors/bag/first_messages.h"
#include "sensors/bag/ros_messages.h"
#include "sensors/camera/rectifier.h"

namespace maploop::sensors {
namespace {

bool are_rectified(const Topic& images) {
  return images.name.find("rect") != std::string::npos;
}

const TopicSummary& summary_of(const BagSummary& bag, const Topic& topic) {
  return *std::ranges::find(
      bag.topics, topic.name,
      [](const TopicSummary& s) -> const std::string& { return s.topic.name; });
}

// Returns whether the stamps of headers can be used for all sensors.
bool headers_are_sound(const std::vector<FirstMessages>& all) {
  std::vector<Time> begins;
  for (const FirstMessages& first : all) {
    if (first.headers.empty()) continue;
    if (std::ranges::adjacent_find(first.headers, std::greater_equal{}) != first.headers.end())
      return false;
    begins.push_back(first.headers.front());
  }
  if (begins.empty()) return true;
  const auto [least, most] = std::ranges::minmax(begins);
  return input_limits::within(input_limits::longest_gap, least, most);
}

}  // namespace

// Holds what is needed while a recording is opened.
struct BagRecording::Opening {
  const BagSummary bag;
  std::map<BagSensor, FirstMessages> first;

  std::string frame(BagSensor sensor) const {
    const auto found = first.find(sensor);
    return found == first.end() ? std::string() : found->second.frame;
  }
};

BagRecording::~BagRecording() = default;

BagRecording::BagRecording(const std::filesystem::path& path, BagSummary summary,
                           const BagParameters& parameters, const BagVehicle& vehicle,
                           const BagLimits& limits)
    : raw_cameras_(vehicle.cameras) {
  Opening opening{std::move(summary), {}};
  choice_ = choose_topics(path, opening.bag, parameters.topics);
  notes_ = choice_.notes;
  BagSettings settings{path, parameters, vehicle, limits, true, {}, 1.0};
  for (const BagSensor sensor : {BagSensor::camera_left, BagSensor::lidar, BagSensor::imu,
                                 BagSensor::gnss, BagSensor::wheel}) {
    if (const Topic* topic = choice_.find(sensor))
      opening.first[sensor] = first_messages(path, *topic);
  }
  std::erase_if(opening.first, [](const auto& item) { return item.second.headers.empty(); });
  set_stamp_rule(opening, settings);
  open_camera(path);
  open_body(path, opening, settings);
  if (const Topic* topic = choice_.find(BagSensor::lidar))
    set_turn(summary_of(opening.bag, *topic), settings);
  settings_ = std::make_shared<const BagSettings>(std::move(settings));
  find_span(opening);
}

void BagRecording::set_stamp_rule(const Opening& opening, BagSettings& settings) {
  std::vector<FirstMessages> all;
  for (const auto& [sensor, first] : opening.first) all.push_back(first);
  const BagStamps rule = settings.parameters.stamps;
  settings.header_stamps =
      rule == BagStamps::automatic ? headers_are_sound(all) : rule == BagStamps::header;
  if (rule == BagStamps::automatic && !settings.header_stamps) {
    notes_.push_back(
        "The stamps of the messages do not increase, or are not of one clock: the times at which "
        "they were received are used.");
  }
}

void BagRecording::open_camera(const std::filesystem::path& path) {
  const auto leave_out = [&](const std::string& why) {
    notes_.push_back("The images of " + choice_.find(BagSensor::camera_left)->name +
                     " are not used: " + why);
    choice_.topics.erase(BagSensor::camera_left);
  };
  const Topic* left = choice_.find(BagSensor::camera_left);
  if (left == nullptr) return;
  if (raw_cameras_) {
    calibration_.stereo = raw_cameras_->rectified;
    return;
  }
  const Topic* left_info = choice_.find(BagSensor::camera_left_info);
  const Topic* right_info = choice_.find(BagSensor::camera_right_info);
  if (left_info == nullptr || right_info == nullptr) {
    leave_out(
        "there is no calibration of both cameras (topics camera_info); "
        "[vehicle.camera] calibration of the configuration can state it.");
    return;
  }
  try {
    RosStereo stereo = read_stereo(path, *left_info, *right_info, are_rectified(*left));
    calibration_.stereo = stereo.rectified;
    raw_cameras_ = std::move(stereo.raw);
  } catch (const std::invalid_argument& e) {
    leave_out(std::string("the calibration cannot be used: ") + e.what() + ".");
  }
}

void BagRecording::open_body(const std::filesystem::path& path, const Opening& opening,
                             BagSettings& settings) {
  SensorFrames frames;
  if (has(BagSensor::camera_left)) frames.camera = opening.frame(BagSensor::camera_left);
  if (has(BagSensor::lidar)) frames.lidar = opening.frame(BagSensor::lidar);
  frames.imu = opening.frame(BagSensor::imu);
  if (const Topic* topic = choice_.find(BagSensor::imu)) {
    constexpr double standard_gravity = 9.80665;  // m/s^2
    frames.force = mean_force(path, *topic);
    if (std::abs(frames.force.norm() - 1.0) < 0.2) {
      settings.force_scale = standard_gravity;
      notes_.push_back("The specific force of " + topic->name + " is taken to be in g.");
    }
  }
  const BodyFrame body = choose_body_frame(read_frames(path, opening.bag), frames);
  notes_.insert(notes_.end(), body.notes.begin(), body.notes.end());
  calibration_.T_body_velo = body.T_body_lidar;
  calibration_.stereo.T_body_cam = body.T_body_camera;
  if (raw_cameras_) {
    const auto T_body_left = raw_cameras_->T_body_left.value_or(body.T_body_camera);
    calibration_.stereo.T_body_cam = mounted(*raw_cameras_, T_body_left).T_body_cam;
  }
  if (!body.R_body_imu) return;
  const Attitude mount = attitude_from_rotation(*body.R_body_imu);
  mount_ = {true, degrees(mount.roll), -degrees(mount.pitch),
            degrees(yaw_from_azimuth(mount.azimuth))};
}

void BagRecording::set_turn(const TopicSummary& clouds, BagSettings& settings) {
  constexpr double usual = 0.1;  // s
  const double count = static_cast<double>(clouds.messages);
  const double mean = count > 1 ? to_seconds(clouds.last - clouds.first) / (count - 1) : usual;
  settings.turn = from_seconds(mean > 0.0 && mean < settings.limits.max_turn ? mean : usual);
}

void BagRecording::find_span(const Opening& opening) {
  constexpr std::array order{BagSensor::camera_left, BagSensor::lidar, BagSensor::gnss,
                             BagSensor::imu};
  const auto* used = std::ranges::find_if(order, [&](BagSensor sensor) { return has(sensor); });
  const bool imu_alone = used != order.end() && *used == BagSensor::imu;
  if (has(BagSensor::gnss_raw) && (used == order.end() || imu_alone)) {
    const TopicSummary& raw = summary_of(opening.bag, *choice_.find(BagSensor::gnss_raw));
    frame_count_ = raw.messages;
    first_stamp_ = raw.first;
    last_stamp_ = raw.last;
    return;
  }
  if (opening.first.empty() || used == order.end()) {
    std::string topics;
    for (const TopicSummary& s : opening.bag.topics)
      topics += (topics.empty() ? "" : ", ") + s.topic.name + " (" + s.topic.type + ")";
    throw std::runtime_error("the recording '" + settings_->path.string() +
                             "' has no messages of a sensor that can be used: " +
                             (topics.empty() ? "it is empty" : "it has " + topics));
  }
  if (imu_alone) {
    throw std::runtime_error("the recording '" + settings_->path.string() +
                             "' has only an inertial unit, " + choice_.find(*used)->name +
                             ": record the fixes of a GNSS receiver, images or clouds with it");
  }
  const Topic& topic = *choice_.find(*used);
  const TopicSummary& summary = summary_of(opening.bag, topic);
  frame_count_ = summary.messages;
  const auto stamp_of = [&](const RecordedMessage& message) {
    return settings_->header_stamps ? header_of(message).stamp : message.received;
  };
  read_first(settings_->path, {topic.name}, Time::min(), [&](const RecordedMessage& message) {
    first_stamp_ = last_stamp_ = stamp_of(message);
    return false;
  });
  // The index may put the last message later than it is.
  bool found = false;
  for (const Duration before : {Duration(std::chrono::seconds(2)),
                                Duration(std::chrono::minutes(2)), summary.last - summary.first}) {
    read_first(settings_->path, {topic.name}, summary.last - before,
               [&](const RecordedMessage& message) {
                 found = true;
                 last_stamp_ = std::max(last_stamp_, stamp_of(message));
                 return true;
               });
    if (found) return;
  }
}

std::unique_ptr<Source<StereoPair>> BagRecording::camera(Time passed) const {
  auto images = make_bag_camera(settings_, *choice_.find(BagSensor::camera_left),
                                *choice_.find(BagSensor::camera_right), passed);
  return raw_cameras_ ? make_rectified_source(std::move(images), *raw_cameras_, passed)
                      : std::move(images);
}

std::unique_ptr<Source<LidarScan>> BagRecording::lidar(Time passed) const {
  return make_bag_lidar(settings_, *choice_.find(BagSensor::lidar), passed);
}

std::unique_ptr<Source<GnssFix>> BagRecording::gnss() const {
  return make_bag_gnss(settings_, *choice_.find(BagSensor::gnss),
                       choice_.find(BagSensor::gnss_velocity));
}

std::string BagRecording::observations(std::vector<std::string>& notes) const {
  SourceReport report;
  std::string ubx = read_bag_ubx(*settings_, *choice_.find(BagSensor::gnss_raw),
                                 choice_.find(BagSensor::gnss_subframes), report);
  if (report.refused > 0) {
    notes.push_back(std::to_string(report.refused) +
                    " of the receiver's raw messages are not used, the first because: " +
                    report.refusals.front().reason + ".");
  }
  return ubx;
}

std::unique_ptr<Source<WheelSpeed>> BagRecording::wheel() const {
  return make_bag_wheel(settings_, *choice_.find(BagSensor::wheel));
}

std::unique_ptr<Source<ImuSample>> BagRecording::imu(std::unique_ptr<Source<GnssFix>> fixes,
                                                     const MountParameters& given,
                                                     double rear_axle_distance) const {
  return std::make_unique<AlignedImu>(make_bag_imu(settings_, *choice_.find(BagSensor::imu)),
                                      std::move(fixes), given.given ? given : mount_,
                                      rear_axle_distance, settings_->path);
}

}  // namespace maploop::sensors
