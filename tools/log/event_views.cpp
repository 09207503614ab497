#include "tools/log/event_views.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "sensors/image/jpeg.h"
#include "tools/log/match_scene.h"

namespace maploop::lcm_log {
namespace {

using namespace foxglove;

// Returns the message of an event, if it is a message of this type with sound values.
template <class Lcm>
auto message_of(const LogEvent& event, const schema::Schema& schema)
    -> std::optional<decltype(from_lcm(Lcm{}))> {
  Lcm message{};
  if (!schema::checked_decode(schema, event.data, message)) return std::nullopt;
  try {
    return from_lcm(message);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

Pose pose_of(const Eigen::Vector3d& position, const Attitude& attitude) {
  return {position, Eigen::Quaterniond(rotation_enu_body(attitude))};
}

Pose pose_of(const Eigen::Isometry3d& T) {
  return {T.translation(), Eigen::Quaterniond(T.linear())};
}

// Returns the covariance of position and of the rotation vector, both in the axes of the map.
Eigen::Matrix<double, 6, 6> pose_covariance(const NavState& s) {
  Eigen::Matrix<double, 6, 9> turns = Eigen::Matrix<double, 6, 9>::Zero();
  const Eigen::Matrix3d R = rotation_enu_body(s.attitude);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  turns.topLeftCorner<3, 3>().setIdentity();
  turns.bottomRightCorner<3, 3>() << -up, -up.cross(R.col(0)).normalized(), R.col(0);
  return turns * s.covariance * turns.transpose();
}

// Shows one event.
class Viewed {
 public:
  Viewed(const LogEvent& event, const schema::Schema& schema,
         const std::function<void(std::string_view, const View&)>& use)
      : event_(event), schema_(schema), use_(use) {}

  void nav_state() const {
    const auto s = message_of<maploop_lcm::nav_state_t>(event_, schema_);
    if (!s || s->status == NavStatus::uninitialized) return;
    const Geodetic place = LocalFrame(s->origin).to_geodetic(s->position_enu);
    const Pose pose = pose_of(s->position_enu, s->attitude);
    show("/map/fix", LocationFix{s->stamp, place, s->covariance.topLeftCorner<3, 3>()});
    show("/map/pose", PoseInFrame{s->stamp, "map", pose,
                                  rotation_enu_body(s->attitude).transpose() * s->velocity_enu,
                                  pose_covariance(*s)});
    show("/tf", FrameTransform{s->stamp, "map", "body", pose});
    show("/tf", FrameTransform{s->stamp, "map", "body_enu", {.position = s->position_enu}});
  }
  void odom_state() const {
    const auto s = message_of<maploop_lcm::odom_state_t>(event_, schema_);
    if (!s || s->status == NavStatus::uninitialized) return;
    show("/odom/pose",
         PoseInFrame{s->stamp, "odom", pose_of(s->position, s->attitude), s->velocity_body});
  }
  void map_match() const {
    maploop_lcm::map_match_t match{};
    if (schema::checked_decode(schema_, event_.data, match) &&
        match.refusal == maploop_lcm::map_match_t::NONE) {
      show("/map/road", match_scene(match));
    }
  }
  void gnss_fix() const {
    const auto fix = message_of<maploop_lcm::gnss_fix_t>(event_, schema_);
    if (fix) show("/gnss/fix", LocationFix{fix->stamp, fix->position, fix->position_covariance});
  }
  void imu() const {
    if (const auto sample = message_of<maploop_lcm::imu_t>(event_, schema_)) show("/imu", *sample);
  }
  void truth() const {
    const auto pose = message_of<maploop_lcm::reference_pose_t>(event_, schema_);
    if (!pose) return;
    const double variance = pose->position_accuracy * pose->position_accuracy;
    show("/truth/fix",
         LocationFix{pose->stamp, pose->position, variance * Eigen::Matrix3d::Identity()});
  }
  void calibration() const {
    const auto c = message_of<maploop_lcm::calibration_t>(event_, schema_);
    if (!c) return;
    const Time stamp = from_nanoseconds(1000 * event_.time_us);
    show("/tf_static", FrameTransform{stamp, "body", "cam", pose_of(c->stereo.T_body_cam)});
    show("/tf_static", FrameTransform{stamp, "body", "velo", pose_of(c->T_body_velo)});
  }
  void camera() const {
    maploop_lcm::stereo_pair_t pair{};
    if (!schema::checked_decode(schema_, event_.data, pair)) return;
    image("/camera/left", pair, pair.left);
    image("/camera/right", pair, pair.right);
  }
  void velodyne() const {
    maploop_lcm::lidar_scan_t scan{};
    if (!schema::checked_decode(schema_, event_.data, scan)) return;
    show("/velodyne", PointCloud{from_nanoseconds(scan.header.stamp_ns), "velo", scan.points});
  }

 private:
  void show(std::string_view topic, const View& shown) const { use_(topic, shown); }
  void image(std::string_view topic, const maploop_lcm::stereo_pair_t& pair,
             const std::vector<std::uint8_t>& pixels) const {
    constexpr int quality = 80;
    std::vector<std::uint8_t> jpeg;
    try {
      sensors::encode_jpeg(pixels, pair.width, pair.height, quality, jpeg);
    } catch (const std::runtime_error&) {
      return;  // of a size that is none
    }
    show(topic, CompressedImage{from_nanoseconds(pair.header.stamp_ns), "cam", jpeg});
  }

  const LogEvent& event_;
  const schema::Schema& schema_;
  const std::function<void(std::string_view, const View&)>& use_;
};

struct ChannelView {
  std::string_view channel;
  void (Viewed::*show)() const;
};
constexpr std::array shown_channels{
    ChannelView{channel_names::nav_state, &Viewed::nav_state},
    ChannelView{channel_names::odom_state, &Viewed::odom_state},
    ChannelView{channel_names::map_match, &Viewed::map_match},
    ChannelView{channel_names::gnss_fix, &Viewed::gnss_fix},
    ChannelView{channel_names::truth, &Viewed::truth},
    ChannelView{channel_names::imu, &Viewed::imu},
    ChannelView{channel_names::calibration, &Viewed::calibration},
    ChannelView{channel_names::camera, &Viewed::camera},
    ChannelView{channel_names::velodyne, &Viewed::velodyne},
};

}  // namespace

void view(const LogEvent& event, const schema::Schema& schema,
          const std::function<void(std::string_view topic, const View&)>& use) {
  for (const ChannelView& channel : shown_channels)
    if (event.channel == channel.channel) (Viewed(event, schema, use).*channel.show)();
}

}  // namespace maploop::lcm_log
