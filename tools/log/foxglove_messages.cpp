#include "tools/log/foxglove_messages.h"

#include <array>
#include <optional>
#include <stdexcept>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "sensors/image/jpeg.h"
#include "tools/log/foxglove_schemas.h"

namespace maploop::lcm_log {
namespace {

using namespace foxglove;
using nlohmann::json;

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

// Shows one event.
class Viewed {
 public:
  Viewed(const LogEvent& event, const schema::Schema& schema,
         const std::function<void(const FoxgloveMessage&)>& use)
      : event_(event), schema_(schema), use_(use) {}

  void nav_state() const {
    const auto s = message_of<maploop_lcm::nav_state_t>(event_, schema_);
    if (!s || s->status == NavStatus::uninitialized) return;
    const Geodetic place = LocalFrame(s->origin).to_geodetic(s->position_enu);
    const Pose pose = pose_of(s->position_enu, s->attitude);
    show("/map/fix", LocationFix{s->stamp, place, s->covariance.topLeftCorner<3, 3>()});
    show("/map/pose", PoseInFrame{s->stamp, "map", pose});
    show("/tf", FrameTransform{s->stamp, "map", "body", pose});
  }
  void odom_state() const {
    const auto s = message_of<maploop_lcm::odom_state_t>(event_, schema_);
    if (!s || s->status == NavStatus::uninitialized) return;
    show("/odom/pose", PoseInFrame{s->stamp, "odom", pose_of(s->position, s->attitude)});
  }
  void gnss_fix() const {
    const auto fix = message_of<maploop_lcm::gnss_fix_t>(event_, schema_);
    if (fix) show("/gnss/fix", LocationFix{fix->stamp, fix->position, fix->position_covariance});
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
  template <class T>
  void show(std::string_view topic, const T& shown) const {
    use_({topic, T::name, T::object().of(shown).dump()});
  }
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
  const std::function<void(const FoxgloveMessage&)>& use_;
};

constexpr std::array nav_topics{FoxgloveTopic{"/map/fix", LocationFix::name},
                                FoxgloveTopic{"/map/pose", PoseInFrame::name},
                                FoxgloveTopic{"/tf", FrameTransform::name}};
constexpr std::array odom_topics{FoxgloveTopic{"/odom/pose", PoseInFrame::name}};
constexpr std::array gnss_topics{FoxgloveTopic{"/gnss/fix", LocationFix::name}};
constexpr std::array truth_topics{FoxgloveTopic{"/truth/fix", LocationFix::name}};
constexpr std::array calibration_topics{FoxgloveTopic{"/tf_static", FrameTransform::name}};
constexpr std::array camera_topics{FoxgloveTopic{"/camera/left", CompressedImage::name},
                                   FoxgloveTopic{"/camera/right", CompressedImage::name}};
constexpr std::array velodyne_topics{FoxgloveTopic{"/velodyne", PointCloud::name}};

struct ChannelView {
  std::string_view channel;
  void (Viewed::*show)() const;
  std::span<const FoxgloveTopic> topics;
};
constexpr std::array shown_channels{
    ChannelView{channel_names::nav_state, &Viewed::nav_state, nav_topics},
    ChannelView{channel_names::odom_state, &Viewed::odom_state, odom_topics},
    ChannelView{channel_names::gnss_fix, &Viewed::gnss_fix, gnss_topics},
    ChannelView{channel_names::truth, &Viewed::truth, truth_topics},
    ChannelView{channel_names::calibration, &Viewed::calibration, calibration_topics},
    ChannelView{channel_names::camera, &Viewed::camera, camera_topics},
    ChannelView{channel_names::velodyne, &Viewed::velodyne, velodyne_topics},
};

template <class... T>
json schema_among(std::string_view name) {
  json schema;
  (static_cast<void>(name == T::name ? schema = T::object().schema() : json()), ...);
  return schema;
}

}  // namespace

void show_in_foxglove(const LogEvent& event, const schema::Schema& schema,
                      const std::function<void(const FoxgloveMessage&)>& use) {
  for (const ChannelView& view : shown_channels)
    if (event.channel == view.channel) (Viewed(event, schema, use).*view.show)();
}

std::span<const FoxgloveTopic> foxglove_topics(std::string_view channel) {
  for (const ChannelView& view : shown_channels)
    if (channel == view.channel) return view.topics;
  return {};
}

std::string foxglove_schema(std::string_view schema_name) {
  json schema = schema_among<LocationFix, PoseInFrame, FrameTransform, CompressedImage, PointCloud>(
      schema_name);
  schema["title"] = schema_name;
  return schema.dump();
}

}  // namespace maploop::lcm_log
