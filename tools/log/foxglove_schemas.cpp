#include "tools/log/foxglove_schemas.h"

#include <cstddef>

#include "msgs/base64.h"
#include "msgs/frames.h"
#include "msgs/lidar_scan.h"

namespace maploop::foxglove {
namespace {

using nlohmann::json;

const json number = {{"type", "number"}}, text = {{"type", "string"}},
           integer = {{"type", "integer"}};
constexpr int float32 = 7;           // a number of PointCloud
constexpr int known_covariance = 3;  // a number of LocationFix
const json bytes = {{"type", "string"}, {"contentEncoding", "base64"}};

json list_of(json item) {
  return {{"type", "array"}, {"items", std::move(item)}};
}

// A property that is an object of its own.
template <class T, class Part>
Property<T> part(std::string name, const Object<Part>& object, const Part& (*of)(const T&)) {
  return {std::move(name), object.schema(), [&object, of](const T& t) { return object.of(of(t)); }};
}

const Object<Time>& time_object() {
  constexpr std::int64_t second = 1'000'000'000;
  static const Object<Time> object{
      {"sec", integer, [](const Time& t) { return json(to_nanoseconds(t) / second); }},
      {"nsec", integer, [](const Time& t) { return json(to_nanoseconds(t) % second); }}};
  return object;
}

const Object<Eigen::Vector3d>& vector_object() {
  using Vector = Eigen::Vector3d;
  static const Object<Vector> object{{"x", number, [](const Vector& v) { return json(v.x()); }},
                                     {"y", number, [](const Vector& v) { return json(v.y()); }},
                                     {"z", number, [](const Vector& v) { return json(v.z()); }}};
  return object;
}

const Object<Eigen::Quaterniond>& rotation_object() {
  using Rotation = Eigen::Quaterniond;
  static const Object<Rotation> object{
      {"x", number, [](const Rotation& q) { return json(q.x()); }},
      {"y", number, [](const Rotation& q) { return json(q.y()); }},
      {"z", number, [](const Rotation& q) { return json(q.z()); }},
      {"w", number, [](const Rotation& q) { return json(q.w()); }}};
  return object;
}

const Object<Pose>& pose_object() {
  static const Object<Pose> object{
      part<Pose, Eigen::Vector3d>(
          "position", vector_object(), [](const Pose& p) -> auto& { return p.position; }),
      part<Pose, Eigen::Quaterniond>(
          "orientation", rotation_object(), [](const Pose& p) -> auto& { return p.orientation; })};
  return object;
}

template <class T>
Property<T> timestamp() {
  return part<T, Time>(
      "timestamp", time_object(), [](const T& t) -> auto& { return t.stamp; });
}

template <class T>
Property<T> frame_id() {
  return {"frame_id", text, [](const T& t) { return json(t.frame); }};
}

// One of the fields of a point, as PointCloud describes them.
struct PointField {
  const char* name;
  std::size_t offset;
};

const Object<PointField>& point_field_object() {
  static const Object<PointField> object{
      {"name", text, [](const PointField& f) { return json(f.name); }},
      {"offset", integer, [](const PointField& f) { return json(f.offset); }},
      {"type", integer, [](const PointField&) { return json(float32); }}};
  return object;
}

json point_fields() {
  json fields = json::array();
  for (const PointField& field : {PointField{"x", offsetof(LidarPoint, x)},
                                  {"y", offsetof(LidarPoint, y)},
                                  {"z", offsetof(LidarPoint, z)},
                                  {"intensity", offsetof(LidarPoint, reflectance)}})
    fields.push_back(point_field_object().of(field));
  return fields;
}

}  // namespace

const Object<LocationFix>& LocationFix::object() {
  using Fix = LocationFix;
  static const Object<Fix> object{
      timestamp<Fix>(),
      {"frame_id", text, [](const Fix&) { return json("map"); }},
      {"latitude", number, [](const Fix& f) { return json(degrees(f.place.latitude)); }},
      {"longitude", number, [](const Fix& f) { return json(degrees(f.place.longitude)); }},
      {"altitude", number, [](const Fix& f) { return json(f.place.height); }},
      {"position_covariance", list_of(number),
       [](const Fix& f) {
         return json(
             std::vector<double>(f.covariance.data(), f.covariance.data() + f.covariance.size()));
       }},
      {"position_covariance_type", integer, [](const Fix&) { return json(known_covariance); }}};
  return object;
}

const Object<PoseInFrame>& PoseInFrame::object() {
  static const Object<PoseInFrame> object{
      timestamp<PoseInFrame>(), frame_id<PoseInFrame>(),
      part<PoseInFrame, Pose>(
          "pose", pose_object(), [](const PoseInFrame& p) -> auto& { return p.pose; })};
  return object;
}

const Object<FrameTransform>& FrameTransform::object() {
  using Tf = FrameTransform;
  static const Object<Tf> object{
      timestamp<Tf>(),
      {"parent_frame_id", text, [](const Tf& t) { return json(t.parent); }},
      {"child_frame_id", text, [](const Tf& t) { return json(t.child); }},
      part<Tf, Eigen::Vector3d>(
          "translation", vector_object(), [](const Tf& t) -> auto& { return t.pose.position; }),
      part<Tf, Eigen::Quaterniond>(
          "rotation", rotation_object(), [](const Tf& t) -> auto& { return t.pose.orientation; })};
  return object;
}

const Object<CompressedImage>& CompressedImage::object() {
  using Image = CompressedImage;
  static const Object<Image> object{
      timestamp<Image>(),
      frame_id<Image>(),
      {"data", bytes, [](const Image& i) { return json(base64(i.jpeg)); }},
      {"format", text, [](const Image&) { return json("jpeg"); }}};
  return object;
}

const Object<PointCloud>& PointCloud::object() {
  using Cloud = PointCloud;
  static const Pose origin;
  static const Object<Cloud> object{
      timestamp<Cloud>(),
      frame_id<Cloud>(),
      part<Cloud, Pose>(
          "pose", pose_object(), [](const Cloud&) -> auto& { return origin; }),
      {"point_stride", integer, [](const Cloud&) { return json(sizeof(LidarPoint)); }},
      {"fields", list_of(point_field_object().schema()),
       [](const Cloud&) { return point_fields(); }},
      {"data", bytes, [](const Cloud& c) { return json(base64(c.points)); }}};
  return object;
}

}  // namespace maploop::foxglove
