#include "tools/log/foxglove_schemas.h"

#include <cstddef>

#include "msgs/base64.h"
#include "msgs/frames.h"
#include "msgs/lidar_scan.h"

namespace maploop::foxglove {
namespace {

using nlohmann::json;

const json number = {{"type", "number"}}, text = {{"type", "string"}},
           integer = {{"type", "integer"}}, yes_or_no = {{"type", "boolean"}};
constexpr int float32 = 7;                    // a number of PointCloud
constexpr int known_covariance = 3;           // a number of LocationFix
constexpr int line_strip = 0, line_loop = 1;  // numbers of SceneUpdate
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

template <class T>
Property<T> constant(std::string name, json schema, json value) {
  return {std::move(name), std::move(schema),
          [value = std::move(value)](const T&) { return value; }};
}

// A list of which there is no entry.
template <class T>
Property<T> none(std::string name) {
  return constant<T>(std::move(name), list_of({{"type", "object"}}), json::array());
}

const Object<SceneColor>& color_object() {
  static const Object<SceneColor> object{
      {"r", number, [](const SceneColor& c) { return json(c.red); }},
      {"g", number, [](const SceneColor& c) { return json(c.green); }},
      {"b", number, [](const SceneColor& c) { return json(c.blue); }},
      constant<SceneColor>("a", number, 1.0)};
  return object;
}

const Object<SceneLine>& line_object() {
  static const Object<SceneLine> object{
      {"type", integer,
       [](const SceneLine& line) { return json(line.closed ? line_loop : line_strip); }},
      constant<SceneLine>("pose", pose_object().schema(), pose_object().of({})),
      constant<SceneLine>("thickness", number, scene_line_width),
      constant<SceneLine>("scale_invariant", yes_or_no, false),
      {"points", list_of(vector_object().schema()),
       [](const SceneLine& line) {
         json points = json::array();
         for (const Eigen::Vector3d& p : line.points) points.push_back(vector_object().of(p));
         return points;
       }},
      part<SceneLine, SceneColor>(
          "color", color_object(), [](const SceneLine& line) -> auto& { return line.color; }),
      none<SceneLine>("colors"),
      none<SceneLine>("indices")};
  return object;
}

const Object<SceneText>& text_object() {
  static const Object<SceneText> object{
      {"pose", pose_object().schema(),
       [](const SceneText& t) { return pose_object().of({.position = t.place}); }},
      constant<SceneText>("billboard", yes_or_no, true),
      constant<SceneText>("font_size", number, scene_text_height),
      constant<SceneText>("scale_invariant", yes_or_no, false),
      constant<SceneText>("color", color_object().schema(), color_object().of(scene_text_color)),
      {"text", text, [](const SceneText& t) { return json(t.text); }}};
  return object;
}

const Object<SceneUpdate>& entity_object() {
  using Scene = SceneUpdate;
  static const Object<Scene> object{
      timestamp<Scene>(),
      frame_id<Scene>(),
      {"id", text, [](const Scene& s) { return json(s.id); }},
      constant<Scene>("lifetime", time_object().schema(), time_object().of(Time{})),
      constant<Scene>("frame_locked", yes_or_no, false),
      none<Scene>("metadata"),
      none<Scene>("arrows"),
      none<Scene>("cubes"),
      none<Scene>("spheres"),
      none<Scene>("cylinders"),
      none<Scene>("triangles"),
      none<Scene>("models"),
      {"lines", list_of(line_object().schema()),
       [](const Scene& s) {
         json lines = json::array();
         for (const SceneLine& line : s.lines) lines.push_back(line_object().of(line));
         return lines;
       }},
      {"texts", list_of(text_object().schema()),
       [](const Scene& s) { return json::array({text_object().of(s.text)}); }}};
  return object;
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

const Object<SceneUpdate>& SceneUpdate::object() {
  static const Object<SceneUpdate> object{
      none<SceneUpdate>("deletions"),
      {"entities", list_of(entity_object().schema()),
       [](const SceneUpdate& s) { return json::array({entity_object().of(s)}); }}};
  return object;
}

}  // namespace maploop::foxglove
