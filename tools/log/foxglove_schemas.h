// The messages of Foxglove that maploop writes, in JSON
// (docs.foxglove.dev/docs/visualization/message-schemas): one table each says both what a message
// looks like and what is in it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/time.h"

namespace maploop::foxglove {

// One property of the JSON object that shows a T.
template <class T>
struct Property {
  std::string name;
  nlohmann::json schema;
  std::function<nlohmann::json(const T&)> value;
};

// The JSON object that shows a T.
template <class T>
class Object {
 public:
  Object(std::initializer_list<Property<T>> properties) : properties_(properties) {}

  nlohmann::json schema() const {
    nlohmann::json all = nlohmann::json::object();
    for (const Property<T>& p : properties_) all[p.name] = p.schema;
    return {{"type", "object"}, {"properties", std::move(all)}};
  }
  nlohmann::json of(const T& shown) const {
    nlohmann::json object = nlohmann::json::object();
    for (const Property<T>& p : properties_) object[p.name] = p.value(shown);
    return object;
  }

 private:
  std::vector<Property<T>> properties_;
};

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct LocationFix {
  static constexpr std::string_view name = "foxglove.LocationFix";
  static const Object<LocationFix>& object();
  Time stamp;
  Geodetic place;
  Eigen::Matrix3d covariance;  // east, north, up (m^2)
};

struct PoseInFrame {
  static constexpr std::string_view name = "foxglove.PoseInFrame";
  static const Object<PoseInFrame>& object();
  Time stamp;
  std::string_view frame;
  Pose pose;  // of the body
  // Foxglove has no place for these.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, in the body's axes
  // This is that of position (m) and rotation vector (rad) in the frame's axes. Zero means that it
  // is not known.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

struct FrameTransform {
  static constexpr std::string_view name = "foxglove.FrameTransform";
  static const Object<FrameTransform>& object();
  Time stamp;
  std::string_view parent, child;
  Pose pose;
};

struct CompressedImage {
  static constexpr std::string_view name = "foxglove.CompressedImage";
  static const Object<CompressedImage>& object();
  Time stamp;
  std::string_view frame;
  std::span<const std::uint8_t> jpeg;
};

// The points are LidarPoints: x, y, z (m) and reflectance, a float32 each.
struct PointCloud {
  static constexpr std::string_view name = "foxglove.PointCloud";
  static const Object<PointCloud>& object();
  Time stamp;
  std::string_view frame;
  std::span<const std::uint8_t> points;
};

struct SceneColor {
  double red = 0.0, green = 0.0, blue = 0.0;  // 0 to 1
};

struct SceneLine {
  std::vector<Eigen::Vector3d> points;  // m
  SceneColor color;
  bool closed = false;  // whether the last point is joined to the first
};

struct SceneText {
  Eigen::Vector3d place;  // m
  std::string text;       // faces the viewer
};

// This is one entity, which replaces the one of that id that was sent before.
struct SceneUpdate {
  static constexpr std::string_view name = "foxglove.SceneUpdate";
  static const Object<SceneUpdate>& object();
  Time stamp;
  std::string_view frame, id;
  std::vector<SceneLine> lines;
  SceneText text;
};

inline constexpr double scene_line_width = 0.15;  // m
inline constexpr double scene_text_height = 0.8;  // m
inline constexpr SceneColor scene_text_color{0.5, 0.5, 0.5};

}  // namespace maploop::foxglove
