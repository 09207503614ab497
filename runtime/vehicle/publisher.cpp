#include "runtime/vehicle/publisher.h"

#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "msgs/lcm/conversions.h"

namespace maploop::vehicle {
namespace {

constexpr auto look_every = std::chrono::milliseconds(1);

}  // namespace

PublisherEdges::PublisherEdges()
    : imu(make_edge<ImuSample>(edges::imu_publisher, nullptr)),
      gnss(make_edge<GnssFix>(edges::gnss_publisher, nullptr)),
      reference(make_edge<ReferencePose>(edges::reference_publisher, nullptr)),
      odometry(make_edge<RelativeMotion>(edges::stereo_publisher, nullptr)),
      nav_state(make_edge<NavState>(edges::fusion_publisher, nullptr)),
      image_state(make_edge<NavState>(edges::image_states, nullptr)),
      reports(make_edge<RuntimeReport>(edges::health_publisher, nullptr)) {}

Publisher::Publisher(PublisherEdges& edges, std::vector<MessageSink*> sinks, Observer observer)
    : edges_(edges),
      sinks_(std::move(sinks)),
      observer_(std::move(observer)),
      intake_(unused_bell_) {
  forward(edges_.imu, channels::imu);
  forward(edges_.gnss, channels::gnss_fix);
  forward(edges_.reference, channels::truth);
  intake_.add(edges_.odometry, [this](const RelativeMotion& motion) {
    send(channels::visual_odometry, motion.available, to_lcm(motion));
    observer_.odometry(motion);
  });
  intake_.add(edges_.nav_state, [this](const NavState& state) {
    send(channels::nav_state, state.available, to_lcm(state));
    observer_.nav_state(state);
  });
  intake_.add(edges_.image_state, [this](const NavState& state) { observer_.image_state(state); });
}

template <class T>
void Publisher::forward(runtime::Edge<T>& edge, const Channel& channel) {
  intake_.add(
      edge, [this, &channel](const T& sample) { send(channel, sample.available, to_lcm(sample)); });
}

template <class Lcm>
void Publisher::send(const Channel& channel, Time time, const Lcm& message) {
  const MonotonicTime started = runtime::monotonic_now();
  const int size = message.getEncodedSize();
  buffer_.resize(static_cast<std::size_t>(size));
  if (message.encode(buffer_.data(), 0, size) != size) {
    throw std::logic_error("cannot encode a message for " + std::string(channel.name));
  }
  for (MessageSink* sink : sinks_) sink->send({channel.name, time, buffer_, channel.from_data});
  meter_.ran(runtime::monotonic_now() - started);
}

void Publisher::send_reports() {
  while (const RuntimeReport* report = edges_.reports.front()) {
    send(channels::health, report->available, to_lcm(report->health));
    send(channels::deadlines, report->available, to_lcm(report->deadlines));
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
