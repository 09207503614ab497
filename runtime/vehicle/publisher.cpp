#include "runtime/vehicle/publisher.h"

#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {
namespace {

constexpr auto look_every = std::chrono::milliseconds(1);

}  // namespace

PublisherEdges::PublisherEdges(runtime::Overflow overflow)
    : imu("imu -> publisher", capacity::samples, overflow, nullptr),
      gnss("gnss -> publisher", capacity::samples, overflow, nullptr),
      reference("reference -> publisher", capacity::samples, overflow, nullptr),
      odometry("stereo -> publisher", capacity::samples, overflow, nullptr),
      nav_state("fusion -> publisher", capacity::states, overflow, nullptr),
      image_state("fusion at images -> publisher", capacity::samples, overflow, nullptr),
      reports("health -> publisher", capacity::reports, runtime::Overflow::drop_newest, nullptr) {}

Publisher::Publisher(PublisherEdges& edges, std::vector<MessageSink*> sinks, Observer observer)
    : edges_(edges),
      sinks_(std::move(sinks)),
      observer_(std::move(observer)),
      intake_(unused_bell_) {
  forward(edges_.imu, channels::imu);
  forward(edges_.gnss, channels::gnss_fix);
  forward(edges_.reference, channels::truth);
  intake_.add(edges_.odometry, [this](const RelativeMotion& motion) {
    send(channels::visual_odometry, motion.available, to_lcm(motion), true);
    observer_.odometry(motion);
  });
  intake_.add(edges_.nav_state, [this](const NavState& state) {
    send(channels::nav_state, state.available, to_lcm(state), true);
    observer_.nav_state(state);
  });
  intake_.add(edges_.image_state, [this](const NavState& state) { observer_.image_state(state); });
}

template <class T>
void Publisher::forward(runtime::Edge<T>& edge, std::string_view channel) {
  intake_.add(edge, [this, channel](const T& sample) {
    send(channel, sample.available, to_lcm(sample), true);
  });
}

template <class Lcm>
void Publisher::send(std::string_view channel, Time time, const Lcm& message, bool from_data) {
  const int size = message.getEncodedSize();
  buffer_.resize(static_cast<std::size_t>(size));
  if (message.encode(buffer_.data(), 0, size) != size) {
    throw std::logic_error("cannot encode a message for " + std::string(channel));
  }
  for (MessageSink* sink : sinks_) sink->send({channel, time, buffer_, from_data});
}

void Publisher::send_reports() {
  while (const RuntimeReport* report = edges_.reports.front()) {
    send(channels::health, report->available, to_lcm(report->health), false);
    send(channels::deadlines, report->available, to_lcm(report->deadlines), false);
    edges_.reports.pop();
  }
}

void Publisher::run() {
  for (;;) {
    const bool last = intake_.finished() && edges_.reports.promised() == Time::max();
    intake_.take_until(intake_.promised());
    send_reports();
    if (last) return;
    std::this_thread::sleep_for(look_every);
  }
}

}  // namespace maploop::vehicle
