#include "tools/log/foxglove_messages.h"

#include <array>

#include "msgs/lcm/channel_names.h"
#include "tools/log/event_views.h"

namespace maploop::lcm_log {
namespace {

using namespace foxglove;
using nlohmann::json;

constexpr std::array nav_topics{FoxgloveTopic{"/map/fix", LocationFix::name},
                                FoxgloveTopic{"/map/pose", PoseInFrame::name},
                                FoxgloveTopic{"/tf", FrameTransform::name}};
constexpr std::array odom_topics{FoxgloveTopic{"/odom/pose", PoseInFrame::name}};
constexpr std::array gnss_topics{FoxgloveTopic{"/gnss/fix", LocationFix::name}};
constexpr std::array truth_topics{FoxgloveTopic{"/truth/fix", LocationFix::name}};
constexpr std::array match_topics{FoxgloveTopic{"/map/road", SceneUpdate::name}};
constexpr std::array calibration_topics{FoxgloveTopic{"/tf_static", FrameTransform::name}};
constexpr std::array camera_topics{FoxgloveTopic{"/camera/left", CompressedImage::name},
                                   FoxgloveTopic{"/camera/right", CompressedImage::name}};
constexpr std::array velodyne_topics{FoxgloveTopic{"/velodyne", PointCloud::name}};

struct ChannelTopics {
  std::string_view channel;
  std::span<const FoxgloveTopic> topics;
};
constexpr std::array shown_topics{
    ChannelTopics{channel_names::nav_state, nav_topics},
    ChannelTopics{channel_names::odom_state, odom_topics},
    ChannelTopics{channel_names::gnss_fix, gnss_topics},
    ChannelTopics{channel_names::truth, truth_topics},
    ChannelTopics{channel_names::map_match, match_topics},
    ChannelTopics{channel_names::calibration, calibration_topics},
    ChannelTopics{channel_names::camera, camera_topics},
    ChannelTopics{channel_names::velodyne, velodyne_topics},
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
  view(event, schema, [&](std::string_view topic, const View& shown) {
    std::visit(
        [&]<class T>(const T& of) {
          if constexpr (requires { T::object(); }) {
            use({topic, T::name,
                 T::object().of(of).dump(-1, ' ', false, json::error_handler_t::replace)});
          }
        },
        shown);
  });
}

std::span<const FoxgloveTopic> foxglove_topics(std::string_view channel) {
  for (const ChannelTopics& shown : shown_topics)
    if (channel == shown.channel) return shown.topics;
  return {};
}

std::string foxglove_schema(std::string_view schema_name) {
  json schema = schema_among<LocationFix, PoseInFrame, FrameTransform, CompressedImage, PointCloud,
                             SceneUpdate>(schema_name);
  schema["title"] = schema_name;
  return schema.dump();
}

}  // namespace maploop::lcm_log
