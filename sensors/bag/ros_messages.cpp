#include "sensors/bag/ros_messages.h"

#include <cmath>
#include <stdexcept>

#include "sensors/velodyne/data_packet.h"

namespace maploop::sensors {
namespace {

Eigen::Vector3d read_vector(RosCursor& c) {
  double v[3];
  c.numbers(v);
  return {v[0], v[1], v[2]};
}

Eigen::Quaterniond read_quaternion(RosCursor& c) {
  double q[4];
  c.numbers(q);
  return {q[3], q[0], q[1], q[2]};
}

void skip_covariance(RosCursor& c) {
  double covariance[36];
  c.numbers(covariance);
}

void read(RosCursor& c, RosImage& to, std::string_view) {
  to.header = read_header(c);
  to.height = c.number<std::uint32_t>();
  to.width = c.number<std::uint32_t>();
  to.encoding = c.text();
  to.big_endian = c.number<bool>();
  to.step = c.number<std::uint32_t>();
  to.data = c.byte_sequence();
}

void read(RosCursor& c, RosCompressedImage& to, std::string_view) {
  to.header = read_header(c);
  to.format = c.text();
  to.data = c.byte_sequence();
}

void read(RosCursor& c, RosCameraInfo& to, std::string_view) {
  to.header = read_header(c);
  to.height = c.number<std::uint32_t>();
  to.width = c.number<std::uint32_t>();
  to.distortion_model = c.text();
  to.d.resize(c.count(sizeof(double)));
  for (double& d : to.d) d = c.number<double>();
  c.numbers(to.k);
  c.numbers(to.r);
  c.numbers(to.p);
}

// Its points are those of a PointCloud2 of one row. In cdr each but the last is padded to 20 bytes;
// the last one, which has no bytes to read behind it, is left out there.
void read_livox(RosCursor& c, RosPointCloud& to) {
  constexpr std::uint8_t byte = 2, uint32 = 6, float32 = 7;
  constexpr std::uint32_t least_point = 19;  // bytes
  c.number<std::uint64_t>();                 // when the points' times begin; the header says so too
  c.number<std::uint32_t>();                 // the number of points
  std::uint8_t id[4];                        // of the scanner, and what is reserved
  c.numbers(id);
  const bool padded = c.encoding() == RosEncoding::cdr;
  const std::size_t count = c.count(least_point);
  to.fields = {{"offset_time", 0, uint32, 1},
               {"x", 4, float32, 1},
               {"y", 8, float32, 1},
               {"z", 12, float32, 1},
               {"reflectivity", 16, byte, 1}};
  to.height = 1;
  to.point_step = least_point + (padded ? 1 : 0);
  to.width = static_cast<std::uint32_t>(count - (padded && count > 0 ? 1 : 0));
  to.row_step = to.width * to.point_step;
  to.big_endian = false;
  to.data = c.bytes(to.row_step);
}

void read(RosCursor& c, RosPointCloud& to, std::string_view type) {
  to.header = read_header(c);
  if (type.ends_with("CustomMsg")) return read_livox(c, to);
  to.height = c.number<std::uint32_t>();
  to.width = c.number<std::uint32_t>();
  constexpr std::size_t least_field = 13;  // bytes
  to.fields.resize(c.count(least_field));
  for (RosPointField& field : to.fields) {
    field.name = c.text();
    field.offset = c.number<std::uint32_t>();
    field.datatype = c.number<std::uint8_t>();
    field.count = c.number<std::uint32_t>();
  }
  to.big_endian = c.number<bool>();
  to.point_step = c.number<std::uint32_t>();
  to.row_step = c.number<std::uint32_t>();
  to.data = c.byte_sequence();
}

void read(RosCursor& c, RosVelodyneScan& to, std::string_view) {
  to.header = read_header(c);
  constexpr std::size_t stamp_bytes = 8;
  to.packets.resize(c.count(stamp_bytes + velodyne_data_size));
  for (RosVelodynePacket& packet : to.packets) {
    packet.stamp = c.time();
    packet.data = c.bytes(velodyne_data_size);
  }
}

void read(RosCursor& c, RosImu& to, std::string_view) {
  to.header = read_header(c);
  read_quaternion(c);
  double covariance[9];
  c.numbers(covariance);
  to.angular_velocity = read_vector(c);
  c.numbers(covariance);
  to.linear_acceleration = read_vector(c);
}

void read(RosCursor& c, RosFix& to, std::string_view) {
  to.header = read_header(c);
  to.status = c.number<std::int8_t>();
  c.number<std::uint16_t>();  // service
  to.latitude = c.number<double>();
  to.longitude = c.number<double>();
  to.altitude = c.number<double>();
  double covariance[9];
  c.numbers(covariance);
  to.covariance = Eigen::Map<const Eigen::Matrix3d>(covariance);  // it is symmetric
  to.covariance_type = c.number<std::uint8_t>();
}

void read(RosCursor& c, RosTwist& to, std::string_view type) {
  to.header = read_header(c);
  if (type == "nav_msgs/Odometry") {
    c.text();  // child_frame_id
    read_vector(c);
    read_quaternion(c);
    skip_covariance(c);
  }
  to.linear = read_vector(c);
  to.angular = read_vector(c);
}

void read(RosCursor& c, RosTransforms& to, std::string_view) {
  constexpr std::size_t least_transform = 72;  // bytes
  to.transforms.resize(c.count(least_transform));
  for (RosTransform& transform : to.transforms) {
    transform.parent = read_header(c).frame;
    transform.child = c.text();
    const Eigen::Vector3d translation = read_vector(c);
    const Eigen::Quaterniond rotation = read_quaternion(c);
    if (!translation.allFinite() || !(std::abs(rotation.norm() - 1.0) < 1e-2)) {
      throw std::invalid_argument("the transform from '" + transform.parent + "' to '" +
                                  transform.child + "' is not a rotation and a translation");
    }
    transform.T_parent_child = Eigen::Isometry3d(rotation.normalized());
    transform.T_parent_child.pretranslate(translation);
  }
}

// The fields are those of the payload, whose numbers are little endian, too; CDR aligns the list.
void read_payload(RosCursor& c, std::size_t head, std::size_t element, std::size_t alignment,
                  RosUblox& to) {
  to.head = c.bytes(head);
  const std::size_t count = c.count(element);
  constexpr std::size_t count_bytes = 4;
  const bool gap = c.encoding() == RosEncoding::cdr && (head + count_bytes) % alignment != 0;
  if (gap && count > 0) c.bytes(count_bytes);
  to.list = c.bytes(count * element);
}

void read(RosCursor& c, RosRawx& to, std::string_view) {
  constexpr std::size_t head = 16, measurement = 32;
  read_payload(c, head, measurement, sizeof(double), to);
}

void read(RosCursor& c, RosSubframe& to, std::string_view) {
  constexpr std::size_t head = 8, word = 4;
  read_payload(c, head, word, word, to);
}

}  // namespace

RosHeader read_header(RosCursor& c) {
  if (c.encoding() == RosEncoding::ros1) c.number<std::uint32_t>();  // seq
  RosHeader header;
  header.stamp = c.time();
  header.frame = c.text();
  return header;
}

RosCursor cursor_of(const Topic& topic, std::span<const std::uint8_t> message) {
  return {message, topic.encoding == "cdr" ? RosEncoding::cdr : RosEncoding::ros1};
}

template <class T>
void decode(const Topic& topic, std::span<const std::uint8_t> message, T& to) {
  RosCursor cursor = cursor_of(topic, message);
  read(cursor, to, topic.type);
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type cannot be in parentheses
#define MAPLOOP_ROS_TYPE(T) template void decode(const Topic&, std::span<const std::uint8_t>, T&);
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
