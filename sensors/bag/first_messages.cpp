#include "sensors/bag/first_messages.h"

#include <array>
#include <stdexcept>
#include <utility>

namespace maploop::sensors {

void read_first(const std::filesystem::path& path, std::set<std::string> topics, Time begin,
                const std::function<bool(const RecordedMessage&)>& use) {
  if (topics.empty()) return;
  const auto reader = open_messages(path, {std::move(topics), begin});
  for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
    if (item != MessageReader::Item::message) continue;
    try {
      if (!use(reader->message())) return;
    } catch (const std::invalid_argument&) {
      continue;
    }
  }
}

RosHeader header_of(const RecordedMessage& message) {
  RosCursor cursor = cursor_of(*message.topic, message.data);
  return read_header(cursor);
}

FirstMessages first_messages(const std::filesystem::path& path, const Topic& topic) {
  constexpr std::size_t enough = 20;
  FirstMessages first;
  read_first(path, {topic.name}, Time::min(), [&](const RecordedMessage& message) {
    const RosHeader header = header_of(message);
    if (first.headers.empty()) first.frame = header.frame;
    first.headers.push_back(header.stamp);
    return first.headers.size() < enough;
  });
  return first;
}

FrameTree read_frames(const std::filesystem::path& path, const BagSummary& bag) {
  constexpr std::size_t enough = 1000;  // messages
  std::set<std::string> topics;
  for (const TopicSummary& summary : bag.topics)
    if (problem_of<RosTransforms>(summary.topic).empty()) topics.insert(summary.topic.name);
  FrameTree tree;
  std::size_t count = 0;
  read_first(path, std::move(topics), Time::min(), [&](const RecordedMessage& message) {
    RosTransforms transforms;
    decode(*message.topic, message.data, transforms);
    for (const RosTransform& t : transforms.transforms)
      tree.add(t.parent, t.child, t.T_parent_child);
    return ++count < enough;
  });
  return tree;
}

Eigen::Vector3d mean_force(const std::filesystem::path& path, const Topic& topic) {
  constexpr int enough = 100;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  read_first(path, {topic.name}, Time::min(), [&](const RecordedMessage& message) {
    RosImu imu;
    decode(topic, message.data, imu);
    if (imu.linear_acceleration.allFinite()) sum += imu.linear_acceleration;
    return ++count < enough;
  });
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

RosStereo read_stereo(const std::filesystem::path& path, const Topic& left_info,
                      const Topic& right_info, bool images_are_rectified) {
  const std::array<const Topic*, 2> topics{&left_info, &right_info};
  // Their texts are parts of messages, which are kept.
  std::array<std::vector<std::uint8_t>, 2> messages;
  for (std::size_t i = 0; i < 2; ++i) {
    read_first(path, {topics[i]->name}, Time::min(), [&](const RecordedMessage& message) {
      messages[i].assign(message.data.begin(), message.data.end());
      return false;
    });
    if (messages[i].empty())
      throw std::invalid_argument("there is no message of " + topics[i]->name);
  }
  std::array<RosCameraInfo, 2> infos;
  for (std::size_t i = 0; i < 2; ++i) decode(*topics[i], messages[i], infos[i]);
  return stereo_of(infos[0], infos[1], images_are_rectified);
}

}  // namespace maploop::sensors
