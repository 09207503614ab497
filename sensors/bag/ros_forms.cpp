// Knows which types are decoded into which messages, and the fields that their definitions list.
#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string>
#include <string_view>

#include "sensors/bag/ros_messages.h"

namespace maploop::sensors {
namespace {

// A type whose messages are decoded, and what its definition lists, in the form of field_list().
struct RosForm {
  std::string_view type, fields;
};

constexpr std::string_view livox_fields =
    "header header;uint64 timebase;uint32 pointnum;uint8 lidarid;uint8[3] rsvd;"
    "custompoint[] points;";
constexpr std::string_view transforms = "transformstamped[] transforms;";

template <class T>
constexpr std::array<RosForm, 1> forms{};
template <>
constexpr std::array forms<RosImage>{
    RosForm{"sensor_msgs/Image",
            "header header;uint32 height;uint32 width;string encoding;uint8 isbigendian;"
            "uint32 step;uint8[] data;"}};
template <>
constexpr std::array forms<RosCompressedImage>{
    RosForm{"sensor_msgs/CompressedImage", "header header;string format;uint8[] data;"}};
template <>
constexpr std::array forms<RosCameraInfo>{
    RosForm{"sensor_msgs/CameraInfo",
            "header header;uint32 height;uint32 width;string distortionmodel;float64[] d;"
            "float64[9] k;float64[9] r;float64[12] p;uint32 binningx;uint32 binningy;"
            "regionofinterest roi;"}};
template <>
constexpr std::array forms<RosPointCloud>{
    RosForm{"sensor_msgs/PointCloud2",
            "header header;uint32 height;uint32 width;pointfield[] fields;bool isbigendian;"
            "uint32 pointstep;uint32 rowstep;uint8[] data;bool isdense;"},
    RosForm{"livox_ros_driver2/CustomMsg", livox_fields},
    RosForm{"livox_ros_driver/CustomMsg", livox_fields}};
template <>
constexpr std::array forms<RosVelodyneScan>{
    RosForm{"velodyne_msgs/VelodyneScan", "header header;velodynepacket[] packets;"}};
template <>
constexpr std::array forms<RosImu>{
    RosForm{"sensor_msgs/Imu",
            "header header;quaternion orientation;float64[9] orientationcovariance;"
            "vector3 angularvelocity;float64[9] angularvelocitycovariance;"
            "vector3 linearacceleration;float64[9] linearaccelerationcovariance;"}};
template <>
constexpr std::array forms<RosFix>{
    RosForm{"sensor_msgs/NavSatFix",
            "header header;navsatstatus status;float64 latitude;float64 longitude;"
            "float64 altitude;float64[9] positioncovariance;uint8 positioncovariancetype;"}};
template <>
constexpr std::array forms<RosTwist>{
    RosForm{"geometry_msgs/TwistStamped", "header header;twist twist;"},
    RosForm{"geometry_msgs/TwistWithCovarianceStamped", "header header;twistwithcovariance twist;"},
    RosForm{"nav_msgs/Odometry",
            "header header;string childframeid;posewithcovariance pose;"
            "twistwithcovariance twist;"}};
template <>
constexpr std::array forms<RosTransforms>{RosForm{"tf2_msgs/TFMessage", transforms},
                                          RosForm{"tf/tfMessage", transforms}};

template <>
constexpr std::array forms<RosRawx>{
    RosForm{"ublox_msgs/RxmRAWX",
            "float64 rcvtow;uint16 week;int8 leaps;uint8 nummeas;uint8 recstat;uint8 version;"
            "uint8[2] reserved1;rxmrawxmeas[] meas;"}};
template <>
constexpr std::array forms<RosSubframe>{
    RosForm{"ublox_msgs/RxmSFRBX",
            "uint8 gnssid;uint8 svid;uint8 reserved0;uint8 freqid;uint8 numwords;uint8 chn;"
            "uint8 version;uint8 reserved1;uint32[] dwrd;"}};

template <class T>
const RosForm* form_of(std::string_view type) {
  const auto* found = std::ranges::find(forms<T>, type, &RosForm::type);
  return found == forms<T>.end() ? nullptr : found;
}

// Returns "type name;" of each field of the first type in the text, in lower case and without
// underscores, the names of packages, constants and default values.
std::string field_list(const std::string& definition) {
  std::string list;
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line) && !line.starts_with("==");) {
    line.erase(std::min(line.find('#'), line.size()));
    std::istringstream words(line);
    std::string type, name;
    if (!(words >> type >> name) || line.find('=') != std::string::npos) continue;
    type.erase(0, type.rfind('/') + 1);
    list.append(type).append(1, ' ').append(name).append(1, ';');
  }
  std::erase(list, '_');
  std::transform(list.begin(), list.end(), list.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return list;
}

}  // namespace

template <class T>
bool is_of(const Topic& topic) {
  return form_of<T>(topic.type) != nullptr;
}

template <class T>
std::string problem_of(const Topic& topic) {
  const RosForm* form = form_of<T>(topic.type);
  if (form == nullptr)
    return "its type is " + topic.type + ", not " + std::string(forms<T>.front().type);
  if (topic.encoding != "ros1" && topic.encoding != "cdr")
    return "its encoding '" + topic.encoding + "' is not ros1 or cdr";
  // A definition as IDL lists no fields in this form, and is taken for the usual one.
  if (topic.definition.empty() || topic.definition.find("module ") != std::string::npos) return {};
  const std::string listed = field_list(topic.definition);
  if (listed == form->fields) return {};
  return "its definition of " + topic.type + " has other fields: " + listed;
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot be in parentheses
#define MAPLOOP_ROS_TYPE(T)             \
  template bool is_of<T>(const Topic&); \
  template std::string problem_of<T>(const Topic&);
MAPLOOP_ROS_TYPE(RosImage)
MAPLOOP_ROS_TYPE(RosCompressedImage)
MAPLOOP_ROS_TYPE(RosCameraInfo)
MAPLOOP_ROS_TYPE(RosPointCloud)
MAPLOOP_ROS_TYPE(RosVelodyneScan)
MAPLOOP_ROS_TYPE(RosImu)
MAPLOOP_ROS_TYPE(RosFix)
MAPLOOP_ROS_TYPE(RosTwist)
MAPLOOP_ROS_TYPE(RosTransforms)
MAPLOOP_ROS_TYPE(RosRawx)
MAPLOOP_ROS_TYPE(RosSubframe)
#undef MAPLOOP_ROS_TYPE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace maploop::sensors
