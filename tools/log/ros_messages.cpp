#include "tools/log/ros_messages.h"

#include <cstddef>
#include <cstdint>

#include "msgs/frames.h"
#include "msgs/lidar_scan.h"
#include "sensors/bag/byte_cursor.h"
#include "sensors/bag/written_bytes.h"

namespace maploop::lcm_log {
namespace {

using namespace foxglove;
using sensors::bag::as_text, sensors::bag::number, sensors::bag::text;

std::string header(Time stamp, std::string_view frame) {
  constexpr std::int64_t second = 1'000'000'000;
  const std::int64_t t = to_nanoseconds(stamp);
  return number(std::uint32_t{0}) + number(static_cast<std::uint32_t>(t / second)) +
         number(static_cast<std::uint32_t>(t % second)) + text(frame);
}

// The matrices are symmetric: their order does not matter.
template <class Matrix>
std::string numbers(const Matrix& matrix) {
  const auto* data = reinterpret_cast<const char*>(matrix.data());
  return {data, static_cast<std::size_t>(matrix.size()) * sizeof(double)};
}

std::string rotation(const Eigen::Quaterniond& q) {
  return numbers(q.coeffs());  // x, y, z, w
}

template <class T>
struct Written;

template <>
struct Written<LocationFix> {
  static const RosType& type() { return nav_sat_fix_type; }
  static std::string message(const LocationFix& fix) {
    constexpr std::int8_t has_fix = 0;
    constexpr std::uint16_t gps = 1;
    constexpr std::uint8_t known_covariance = 3;
    return header(fix.stamp, "map") + number(has_fix) + number(gps) +
           number(degrees(fix.place.latitude)) + number(degrees(fix.place.longitude)) +
           number(fix.place.height) + numbers(fix.covariance) + number(known_covariance);
  }
};

template <>
struct Written<PoseInFrame> {
  static const RosType& type() { return odometry_type; }
  static std::string message(const PoseInFrame& p) {
    const Eigen::Matrix<double, 6, 6> unknown = Eigen::Matrix<double, 6, 6>::Zero();
    return header(p.stamp, p.frame) + text("body") + numbers(p.pose.position) +
           rotation(p.pose.orientation) + numbers(p.covariance) + numbers(p.velocity) +
           numbers(Eigen::Vector3d::Zero().eval()) + numbers(unknown);
  }
};

template <>
struct Written<FrameTransform> {
  static const RosType& type() { return transforms_type; }
  static std::string message(const FrameTransform& t) {
    return number(std::uint32_t{1}) + header(t.stamp, t.parent) + text(t.child) +
           numbers(t.pose.position) + rotation(t.pose.orientation);
  }
};

template <>
struct Written<CompressedImage> {
  static const RosType& type() { return compressed_image_type; }
  static std::string message(const CompressedImage& image) {
    return header(image.stamp, image.frame) + text("jpeg") + text(as_text(image.jpeg));
  }
};

template <>
struct Written<PointCloud> {
  static const RosType& type() { return point_cloud_type; }
  static std::string message(const PointCloud& cloud) {
    constexpr std::uint8_t float32 = 7, no = 0, yes = 1;
    constexpr std::uint32_t step = sizeof(LidarPoint);
    const auto size = static_cast<std::uint32_t>(cloud.points.size());
    std::string fields;
    for (const auto& [name, offset] :
         {std::pair("x", offsetof(LidarPoint, x)), std::pair("y", offsetof(LidarPoint, y)),
          std::pair("z", offsetof(LidarPoint, z)),
          std::pair("intensity", offsetof(LidarPoint, reflectance))}) {
      fields += text(name) + number(static_cast<std::uint32_t>(offset)) + number(float32) +
                number(std::uint32_t{1});
    }
    return header(cloud.stamp, cloud.frame) + number(std::uint32_t{1}) + number(size / step) +
           number(std::uint32_t{4}) + fields + number(no) + number(step) + number(size) +
           text(as_text(cloud.points)) + number(yes);
  }
};

template <>
struct Written<SceneUpdate> {
  static const RosType& type() { return markers_type; }
  static std::string message(const SceneUpdate& scene) {
    std::string markers = number(static_cast<std::uint32_t>(scene.lines.size() + 1));
    std::int32_t id = 0;
    for (const SceneLine& line : scene.lines) markers += of_line(scene, line, id++);
    constexpr std::int32_t text_view_facing = 9;
    return markers +
           start(scene, id, text_view_facing, scene.text.place, scene_text_height,
                 scene_text_color) +
           number(none) + number(none) + text(scene.text.text) + end();
  }

 private:
  static constexpr std::uint32_t none = 0;  // entries of a list
  static std::string of_line(const SceneUpdate& scene, const SceneLine& line, std::int32_t id) {
    constexpr std::int32_t line_strip = 4;
    std::string points;
    for (const Eigen::Vector3d& p : line.points) points += numbers(p);
    if (line.closed && !line.points.empty()) points += numbers(line.points.front());
    const auto count = static_cast<std::uint32_t>(points.size() / sizeof(Eigen::Vector3d));
    return start(scene, id, line_strip, Eigen::Vector3d::Zero(), scene_line_width, line.color) +
           number(count) + points + number(none) + text("") + end();
  }
  // From the header to whether the frame is locked; `scale` is a line's width or a text's height.
  static std::string start(const SceneUpdate& scene, std::int32_t id, std::int32_t type,
                           const Eigen::Vector3d& place, double scale, const SceneColor& color) {
    constexpr std::int32_t add = 0;
    constexpr std::uint8_t no = 0;
    std::string rgba;
    for (const double part : {color.red, color.green, color.blue, 1.0})
      rgba += number(static_cast<float>(part));
    return header(scene.stamp, scene.frame) + text(scene.id) + number(id) + number(type) +
           number(add) + numbers(place) + rotation(Eigen::Quaterniond::Identity()) +
           numbers(Eigen::Vector3d::Constant(scale).eval()) + rgba + number(std::int64_t{0}) +
           number(no);
  }
  // Neither a mesh nor its materials.
  static std::string end() { return text("") + number(std::uint8_t{0}); }
};

template <>
struct Written<ImuSample> {
  static const RosType& type() { return imu_type; }
  static std::string message(const ImuSample& s) {
    const Eigen::Vector3d rate(s.roll_rate, s.pitch_rate, s.yaw_rate);
    const Eigen::Vector3d force(s.specific_force_forward, s.specific_force_left,
                                s.specific_force_up);
    const Eigen::Matrix3d unknown = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d not_measured = unknown;
    not_measured(0, 0) = -1.0;
    return header(s.stamp, "body") + rotation(Eigen::Quaterniond::Identity()) +
           numbers(not_measured) + numbers(rate) + numbers(unknown) + numbers(force) +
           numbers(unknown);
  }
};

}  // namespace

const RosType& ros_type(const View& view) {
  return std::visit([]<class T>(const T&) -> const RosType& { return Written<T>::type(); }, view);
}

std::string ros_message(const View& view) {
  return std::visit([]<class T>(const T& of) { return Written<T>::message(of); }, view);
}

std::string ros_bytes(std::span<const std::uint8_t> bytes) {
  return text(as_text(bytes));
}

}  // namespace maploop::lcm_log
