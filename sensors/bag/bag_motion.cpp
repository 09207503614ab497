#include "sensors/bag/topic_stream.h"

namespace maploop::sensors {
namespace {

// Makes a sample from each message of type M: fill(message, sample).
template <class T, class M, class Fill>
std::unique_ptr<Source<T>> make_plain(SharedBagSettings settings, const Topic& topic, Fill fill) {
  return made<T>([stream = TopicStream(std::move(settings), {topic.name}), topic, fill](
                     T& sample, SourceReport& report) mutable {
    M message;
    while (const RecordedMessage* recorded = stream.next(report)) {
      if (!stream.decoded(*recorded, message, report)) continue;
      sample.stamp = sample.available = stream.stamp(message.header, *recorded);
      sample.sequence = stream.number() - 1;
      if (!stream.follows(topic, sample, report)) continue;
      fill(message, sample);
      return true;
    }
    return false;
  });
}

}  // namespace

std::unique_ptr<Source<SixAxisSample>> make_bag_imu(SharedBagSettings settings, const Topic& imu) {
  const double scale = settings->force_scale;
  return make_plain<SixAxisSample, RosImu>(std::move(settings), imu,
                                           [scale](const RosImu& from, SixAxisSample& sample) {
                                             sample.rate = from.angular_velocity;
                                             sample.force = scale * from.linear_acceleration;
                                           });
}

std::unique_ptr<Source<WheelSpeed>> make_bag_wheel(SharedBagSettings settings, const Topic& wheel) {
  const double sigma = settings->parameters.wheel_sigma;
  return make_plain<WheelSpeed, RosTwist>(std::move(settings), wheel,
                                          [sigma](const RosTwist& from, WheelSpeed& sample) {
                                            sample.speed = from.linear.x();
                                            sample.sigma = sigma;
                                          });
}

}  // namespace maploop::sensors
