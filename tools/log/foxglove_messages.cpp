#include "tools/log/foxglove_messages.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"

namespace maploop::lcm_log {
namespace {

using nlohmann::json;

constexpr const char *location = "foxglove.LocationFix", *pose_in_frame = "foxglove.PoseInFrame",
                     *transform = "foxglove.FrameTransform";

json time_of(Time stamp) {
  const std::int64_t ns = to_nanoseconds(stamp);
  constexpr std::int64_t second = 1'000'000'000;
  return {{"sec", ns / second}, {"nsec", ns % second}};
}

json vector_of(const Eigen::Vector3d& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

json rotation_of(const Attitude& attitude) {
  const Eigen::Quaterniond q(rotation_enu_body(attitude));
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

json fix_of(Time stamp, const Geodetic& place, const Eigen::Matrix3d& covariance) {
  constexpr int known = 3;
  return {{"timestamp", time_of(stamp)},
          {"frame_id", "map"},
          {"latitude", degrees(place.latitude)},
          {"longitude", degrees(place.longitude)},
          {"altitude", place.height},
          {"position_covariance",
           std::vector<double>(covariance.data(), covariance.data() + covariance.size())},
          {"position_covariance_type", known}};
}

json pose_of(Time stamp, const char* frame, const Eigen::Vector3d& position,
             const Attitude& attitude) {
  return {{"timestamp", time_of(stamp)},
          {"frame_id", frame},
          {"pose", {{"position", vector_of(position)}, {"orientation", rotation_of(attitude)}}}};
}

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

}  // namespace

void show_in_foxglove(const LogEvent& event, const schema::Schema& schema,
                      const std::function<void(const FoxgloveMessage&)>& use) {
  if (event.channel == channel_names::nav_state) {
    const auto s = message_of<maploop_lcm::nav_state_t>(event, schema);
    if (!s || s->status == NavStatus::uninitialized) return;
    const Geodetic place = LocalFrame(s->origin).to_geodetic(s->position_enu);
    use({"/map/fix", location,
         fix_of(s->stamp, place, s->covariance.topLeftCorner<3, 3>()).dump()});
    use({"/map/pose", pose_in_frame,
         pose_of(s->stamp, "map", s->position_enu, s->attitude).dump()});
    const json tf = {{"timestamp", time_of(s->stamp)},
                     {"parent_frame_id", "map"},
                     {"child_frame_id", "body"},
                     {"translation", vector_of(s->position_enu)},
                     {"rotation", rotation_of(s->attitude)}};
    use({"/tf", transform, tf.dump()});
  } else if (event.channel == channel_names::odom_state) {
    const auto s = message_of<maploop_lcm::odom_state_t>(event, schema);
    if (!s || s->status == NavStatus::uninitialized) return;
    use({"/odom/pose", pose_in_frame, pose_of(s->stamp, "odom", s->position, s->attitude).dump()});
  } else if (event.channel == channel_names::gnss_fix) {
    const auto fix = message_of<maploop_lcm::gnss_fix_t>(event, schema);
    if (!fix) return;
    use({"/gnss/fix", location,
         fix_of(fix->stamp, fix->position, fix->position_covariance).dump()});
  } else if (event.channel == channel_names::truth) {
    const auto pose = message_of<maploop_lcm::reference_pose_t>(event, schema);
    if (!pose) return;
    const double variance = pose->position_accuracy * pose->position_accuracy;
    use({"/truth/fix", location,
         fix_of(pose->stamp, pose->position, variance * Eigen::Matrix3d::Identity()).dump()});
  }
}

std::string foxglove_schema(const std::string& schema_name) {
  const json number = {{"type", "number"}}, text = {{"type", "string"}},
             integer = {{"type", "integer"}};
  const auto object = [](json properties) {
    return json{{"type", "object"}, {"properties", std::move(properties)}};
  };
  const json time = object({{"sec", integer}, {"nsec", integer}});
  const json vector = object({{"x", number}, {"y", number}, {"z", number}});
  const json rotation = object({{"x", number}, {"y", number}, {"z", number}, {"w", number}});
  json schema;
  if (schema_name == location) {
    schema = object({{"timestamp", time},
                     {"frame_id", text},
                     {"latitude", number},
                     {"longitude", number},
                     {"altitude", number},
                     {"position_covariance", {{"type", "array"}, {"items", number}}},
                     {"position_covariance_type", integer}});
  } else if (schema_name == pose_in_frame) {
    schema = object({{"timestamp", time},
                     {"frame_id", text},
                     {"pose", object({{"position", vector}, {"orientation", rotation}})}});
  } else {
    schema = object({{"timestamp", time},
                     {"parent_frame_id", text},
                     {"child_frame_id", text},
                     {"translation", vector},
                     {"rotation", rotation}});
  }
  schema["title"] = schema_name;
  return schema.dump();
}

}  // namespace maploop::lcm_log
