#include "sensors/bag/topic_choice.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "sensors/bag/ros_messages.h"

namespace maploop::sensors {
namespace {

constexpr std::string_view none = "none", compressed = "/compressed";

bool is_image(const Topic& topic) {
  return is_of<RosImage>(topic) || is_of<RosCompressedImage>(topic);
}

// Returns why a topic cannot be this sensor, or nothing.
std::string problem_as(BagSensor sensor, const Topic& topic) {
  if (sensor == BagSensor::camera_left || sensor == BagSensor::camera_right) {
    return is_of<RosCompressedImage>(topic) ? problem_of<RosCompressedImage>(topic)
                                            : problem_of<RosImage>(topic);
  }
  if (sensor == BagSensor::camera_left_info || sensor == BagSensor::camera_right_info)
    return problem_of<RosCameraInfo>(topic);
  if (sensor == BagSensor::lidar) {
    return is_of<RosVelodyneScan>(topic) ? problem_of<RosVelodyneScan>(topic)
                                         : problem_of<RosPointCloud>(topic);
  }
  if (sensor == BagSensor::imu) return problem_of<RosImu>(topic);
  if (sensor == BagSensor::gnss) return problem_of<RosFix>(topic);
  if (sensor == BagSensor::gnss_raw) return problem_of<RosRawx>(topic);
  if (sensor == BagSensor::gnss_subframes) return problem_of<RosSubframe>(topic);
  return problem_of<RosTwist>(topic);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

class Chooser {
 public:
  explicit Chooser(const BagSummary& bag) {
    for (const TopicSummary& summary : bag.topics) topics_.push_back(&summary.topic);
  }

  void take_given(const std::string& text) {
    const std::size_t equals = text.find('=');
    const auto named = value_named<BagSensor>(text.substr(0, equals));
    if (equals == std::string::npos || !named) {
      const auto& names = enum_names<BagSensor>;
      throw std::runtime_error("'" + text + "' is not SENSOR=TOPIC with one of the sensors " +
                               joined({names.begin(), names.end()}));
    }
    const BagSensor sensor = *named;
    const std::string name = text.substr(equals + 1);
    decided_.insert(sensor);
    if (name == none) return;
    const auto found = std::ranges::find(topics_, name, &Topic::name);
    if (found == topics_.end()) {
      std::vector<std::string> there;
      for (const Topic* topic : topics_) there.push_back(topic->name);
      throw std::runtime_error("the recording has no topic '" + name + "' for " +
                               std::string(maploop::to_string(sensor)) + "; it has " +
                               joined(there));
    }
    if (const std::string problem = problem_as(sensor, **found); !problem.empty()) {
      throw std::runtime_error("the topic '" + name + "' cannot be " +
                               std::string(maploop::to_string(sensor)) + ": " + problem);
    }
    choice_.topics[sensor] = **found;
  }

  // The only topic of type T.
  template <class T>
  void look_for(BagSensor sensor) {
    if (decided_.contains(sensor)) return;
    std::vector<std::string> names;
    for (const Topic* topic : topics_) {
      if (!is_of<T>(*topic)) continue;
      if (const std::string problem = problem_of<T>(*topic); !problem.empty()) {
        choice_.notes.push_back("The topic " + topic->name + " is not used: " + problem + ".");
        continue;
      }
      names.push_back(topic->name);
      choice_.topics[sensor] = *topic;
    }
    if (names.size() > 1) ask_for(sensor, names);
  }

  bool has(BagSensor sensor) const { return choice_.find(sensor) != nullptr; }
  void look_for_cameras();
  void look_for_calibration(BagSensor camera, BagSensor info);

  TopicChoice done() {
    for (const Topic* topic : topics_) {
      const bool used = std::ranges::any_of(
          choice_.topics, [&](const auto& chosen) { return chosen.second.name == topic->name; });
      if (used) continue;
      if (is_of<RosTwist>(*topic)) {
        choice_.notes.push_back("The topic " + topic->name + " (" + topic->type +
                                ") is not used; --topic gnss.velocity=" + topic->name +
                                " or --topic wheel=" + topic->name + " says what it is.");
      } else if (is_image(*topic)) {
        choice_.notes.push_back("The images of " + topic->name + " are not used.");
      }
    }
    return std::move(choice_);
  }

 private:
  [[noreturn]] static void ask_for(BagSensor which, const std::vector<std::string>& names) {
    const std::string sensor(maploop::to_string(which));
    throw std::runtime_error("several topics can be the sensor " + sensor + ": " + joined(names) +
                             "; choose one with --topic " + sensor + "=" + names.front() +
                             ", or none with --topic " + sensor +
                             "=none, or with [bag] topics of the configuration");
  }

  std::vector<const Topic*> topics_;
  std::set<BagSensor> decided_;
  TopicChoice choice_;
};

// Returns the name without what it says of compression.
std::string image_name(const Topic& topic) {
  std::string name = topic.name;
  if (name.ends_with(compressed)) name.resize(name.size() - compressed.size());
  return name;
}

// Returns the name that the right camera of a pair has if this is that of the left one.
std::optional<std::string> right_of(const std::string& name) {
  constexpr std::array words{std::pair("left", "right"),        std::pair("Left", "Right"),
                             std::pair("camera_0", "camera_1"), std::pair("camera0", "camera1"),
                             std::pair("cam_0", "cam_1"),       std::pair("cam0", "cam1"),
                             std::pair("image_00", "image_01"), std::pair("infra1", "infra2")};
  for (const auto& [left, right] : words) {
    std::string other = name;
    std::size_t changed = 0;
    for (std::size_t at = 0; (at = other.find(left, at)) != std::string::npos; ++changed)
      other.replace(at, std::string_view(left).size(), right);
    if (changed > 0) return other;
  }
  return std::nullopt;
}

// Returns how well a pair suits; the lower the better.
int rank(const std::string& name) {
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  return (has("rect") ? 0 : 2) + (has("color") || has("colour") || has("rgb") ? 1 : 0);
}

void Chooser::look_for_cameras() {
  if (decided_.contains(BagSensor::camera_left) || decided_.contains(BagSensor::camera_right)) {
    if ((choice_.find(BagSensor::camera_left) == nullptr) !=
        (choice_.find(BagSensor::camera_right) == nullptr))
      throw std::runtime_error("a stereo camera needs both camera.left and camera.right");
    return;
  }
  std::vector<std::pair<const Topic*, const Topic*>> pairs;
  for (const Topic* left : topics_) {
    if (!is_image(*left) || !problem_as(BagSensor::camera_left, *left).empty()) continue;
    const auto name = right_of(image_name(*left));
    if (!name) continue;
    for (const Topic* right : topics_) {
      if (is_image(*right) && image_name(*right) == *name &&
          problem_as(BagSensor::camera_right, *right).empty())
        pairs.emplace_back(left, right);
    }
  }
  if (pairs.empty()) return;
  const auto rank_of = [](const auto& pair) { return rank(image_name(*pair.first)); };
  const int best = rank_of(*std::ranges::min_element(pairs, {}, rank_of));
  std::erase_if(pairs, [&](const auto& pair) { return rank_of(pair) != best; });
  std::set<std::string> names;
  for (const auto& pair : pairs) names.insert(image_name(*pair.first));
  if (names.size() > 1) ask_for(BagSensor::camera_left, {names.begin(), names.end()});
  choice_.topics[BagSensor::camera_left] = *pairs.front().first;
  choice_.topics[BagSensor::camera_right] = *pairs.front().second;
}

void Chooser::look_for_calibration(BagSensor camera, BagSensor info) {
  const Topic* images = choice_.find(camera);
  if (images == nullptr || decided_.contains(info)) return;
  std::string name = image_name(*images);
  name = name.substr(0, name.rfind('/') + 1) + "camera_info";
  const auto found = std::ranges::find(topics_, name, &Topic::name);
  if (found != topics_.end() && problem_of<RosCameraInfo>(**found).empty())
    choice_.topics[info] = **found;
}

}  // namespace

TopicChoice choose_topics(const std::filesystem::path& path, const BagSummary& bag,
                          const std::vector<std::string>& given) {
  Chooser chooser(bag);
  try {
    for (const std::string& text : given) chooser.take_given(text);
    chooser.look_for_cameras();
    chooser.look_for_calibration(BagSensor::camera_left, BagSensor::camera_left_info);
    chooser.look_for_calibration(BagSensor::camera_right, BagSensor::camera_right_info);
    chooser.look_for<RosPointCloud>(BagSensor::lidar);
    if (!chooser.has(BagSensor::lidar)) chooser.look_for<RosVelodyneScan>(BagSensor::lidar);
    chooser.look_for<RosImu>(BagSensor::imu);
    chooser.look_for<RosFix>(BagSensor::gnss);
    chooser.look_for<RosRawx>(BagSensor::gnss_raw);
    chooser.look_for<RosSubframe>(BagSensor::gnss_subframes);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("the recording '" + path.string() + "': " + e.what());
  }
  return chooser.done();
}

}  // namespace maploop::sensors
