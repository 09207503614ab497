// This file defines the messages of ROS 1 and ROS 2 that contain what sensors measure.
//
// Fields and their order are those of the packages std_msgs, sensor_msgs, geometry_msgs, nav_msgs,
// tf2_msgs, velodyne_msgs and ublox_msgs, which ROS 2 kept, but for the number in ROS 1's header
// and for the form of names. Texts and bytes are parts of the message that was decoded, and are
// valid as long as it is.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/time.h"
#include "sensors/bag/message_reader.h"
#include "sensors/bag/ros_cursor.h"

namespace maploop::sensors {

struct RosHeader {
  Time stamp{};
  std::string_view frame;
};

struct RosImage {  // sensor_msgs/Image
  RosHeader header;
  std::uint32_t height = 0, width = 0;  // px
  std::string_view encoding;            // such as "mono8"
  bool big_endian = false;
  std::uint32_t step = 0;  // bytes of a row
  std::span<const std::uint8_t> data;
};

struct RosCompressedImage {  // sensor_msgs/CompressedImage
  RosHeader header;
  std::string_view format;  // such as "mono8; png compressed "
  std::span<const std::uint8_t> data;
};

struct RosCameraInfo {  // sensor_msgs/CameraInfo
  RosHeader header;
  std::uint32_t height = 0, width = 0;  // px
  std::string_view distortion_model;
  std::vector<double> d;
  double k[9] = {}, r[9] = {}, p[12] = {};  // row by row
};

struct RosPointField {
  std::string_view name;
  std::uint32_t offset = 0;   // bytes from the start of a point
  std::uint8_t datatype = 0;  // 1 to 8: int8 uint8 int16 uint16 int32 uint32 float32 float64
  std::uint32_t count = 0;
};

struct RosPointCloud {  // sensor_msgs/PointCloud2, livox_ros_driver2/CustomMsg
  RosHeader header;
  std::uint32_t height = 0, width = 0;  // points
  std::vector<RosPointField> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;  // bytes
  std::span<const std::uint8_t> data;
};

struct RosVelodynePacket {
  Time stamp{};
  std::span<const std::uint8_t> data;
};

struct RosVelodyneScan {  // velodyne_msgs/VelodyneScan
  RosHeader header;
  std::vector<RosVelodynePacket> packets;
};

struct RosImu {  // sensor_msgs/Imu
  RosHeader header;
  Eigen::Vector3d angular_velocity, linear_acceleration;  // rad/s, m/s^2
};

struct RosFix {  // sensor_msgs/NavSatFix
  RosHeader header;
  std::int8_t status = 0;                                // negative: no fix
  double latitude = 0.0, longitude = 0.0;                // deg
  double altitude = 0.0;                                 // m above the ellipsoid
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2, east north up
  std::uint8_t covariance_type = 0;                      // 0: not known
};

// geometry_msgs/TwistStamped, geometry_msgs/TwistWithCovarianceStamped, nav_msgs/Odometry
struct RosTwist {
  RosHeader header;
  Eigen::Vector3d linear, angular;  // m/s, rad/s
};

struct RosTransform {  // geometry_msgs/TransformStamped
  std::string parent, child;
  Eigen::Isometry3d T_parent_child;
};

struct RosTransforms {  // tf2_msgs/TFMessage
  std::vector<RosTransform> transforms;
};

// A message of u-blox's class RXM. Its payload is the head, followed by the list.
struct RosUblox {
  std::span<const std::uint8_t> head, list;
};
struct RosRawx : RosUblox {  // ublox_msgs/RxmRAWX
  static constexpr std::uint8_t id = 0x15;
};
struct RosSubframe : RosUblox {  // ublox_msgs/RxmSFRBX
  static constexpr std::uint8_t id = 0x13;
};

// Reads the header with which every message of a sensor begins.
RosHeader read_header(RosCursor& cursor);

// Returns whether the messages of a topic are of a type that is decoded into T.
template <class T>
bool is_of(const Topic& topic);

// Returns why the messages of a topic cannot be decoded into T, or nothing: they are of another
// type or encoding, or the definition that is stored with them has other fields.
template <class T>
std::string problem_of(const Topic& topic);

// Returns a cursor at the start of a message, in its topic's encoding. Throws std::invalid_argument
// if the message's header is of another form.
RosCursor cursor_of(const Topic& topic, std::span<const std::uint8_t> message);

// Decodes a message of a topic without a problem; buffers of `to` keep their capacity. Throws
// std::invalid_argument whose text is the reason.
template <class T>
void decode(const Topic& topic, std::span<const std::uint8_t> message, T& to);

}  // namespace maploop::sensors
