#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include "sensors/bag/camera_messages.h"
#include "sensors/bag/topic_stream.h"

namespace maploop::sensors {
namespace {

// Waits for its partner.
struct WaitingImage {
  Time stamp{};
  std::vector<std::uint8_t> message;
};

class PairMaker {
 public:
  PairMaker(SharedBagSettings settings, const Topic& left, const Topic& right, Time passed)
      : stream_(std::move(settings), {left.name, right.name}),
        cameras_{Camera{left, {}}, Camera{right, {}}},
        passed_(passed) {}

  bool next(StereoPair& pair, SourceReport& report) {
    while (true) {
      if (take_pair(pair, report)) return true;
      const RecordedMessage* message = stream_.next(report);
      if (message == nullptr) return false;
      Camera& camera = cameras_[message->topic->name == cameras_[0].topic.name ? 0 : 1];
      if (const auto stamp = stamp_of(camera, *message, report)) {
        camera.waiting.push_back({*stamp, {message->data.begin(), message->data.end()}});
        if (camera.waiting.size() > most_waiting) drop(camera, report);
      }
    }
  }

 private:
  struct Camera {
    Topic topic;
    std::deque<WaitingImage> waiting;
  };
  static constexpr std::size_t most_waiting = 8;

  std::optional<Time> stamp_of(const Camera& camera, const RecordedMessage& message,
                               SourceReport& report) {
    const auto found = [&](auto image) -> std::optional<Time> {
      if (!stream_.decoded(message, image, report)) return std::nullopt;
      return stream_.stamp(image.header, message);
    };
    return is_of<RosCompressedImage>(camera.topic) ? found(RosCompressedImage())
                                                   : found(RosImage());
  }

  void drop(Camera& camera, SourceReport& report) {
    stream_.refuse(camera.topic, "there is no image of the other camera at its time", report);
    camera.waiting.pop_front();
  }

  bool take_pair(StereoPair& pair, SourceReport& report) {
    auto& [left, right] = cameras_;
    const BagLimits& limits = stream_.settings().limits;
    while (!left.waiting.empty() && !right.waiting.empty()) {
      WaitingImage l = std::move(left.waiting.front()), r = std::move(right.waiting.front());
      const auto [earlier, later] = std::minmax(l.stamp, r.stamp);
      if (later - earlier > from_seconds(limits.max_pair_skew)) {
        (l.stamp < r.stamp ? right : left).waiting.front() = std::move(l.stamp < r.stamp ? r : l);
        drop(l.stamp < r.stamp ? left : right, report);
        continue;
      }
      left.waiting.pop_front();
      right.waiting.pop_front();
      pair.stamp = earlier;
      pair.available = later + from_seconds(limits.camera_readout);
      pair.sequence = pairs_++;
      if (stream_.follows(left.topic, pair, report) && convert(left, l, pair.left, pair, report) &&
          convert(right, r, pair.right, pair, report))
        return true;
    }
    return false;
  }

  bool convert(const Camera& camera, const WaitingImage& from, GreyImage& to, const Sample& pair,
               SourceReport& report) {
    if (pair.available <= passed_) return true;
    const auto converted = [&](auto image) {
      decode(camera.topic, from.message, image);
      to_grey(image, to);
    };
    try {
      if (is_of<RosCompressedImage>(camera.topic)) {
        converted(RosCompressedImage());
      } else {
        converted(RosImage());
      }
      return true;
    } catch (const std::exception& e) {
      stream_.refuse(camera.topic, e.what(), report);
      return false;
    }
  }

  TopicStream stream_;
  std::array<Camera, 2> cameras_;
  Time passed_;
  std::uint64_t pairs_ = 0;
};

}  // namespace

std::unique_ptr<Source<StereoPair>> make_bag_camera(SharedBagSettings settings, const Topic& left,
                                                    const Topic& right, Time passed) {
  return made_by<StereoPair>(PairMaker(std::move(settings), left, right, passed));
}

}  // namespace maploop::sensors
