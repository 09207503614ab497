#include "runtime/vehicle/output/publisher.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/graph/trace_flows.h"

namespace maploop::vehicle {
namespace {

SelfCalibration message_of(const CalibrationReport& report) {
  SelfCalibration message{report.stamp, {}};
  if (report.properties.front().sigma == 0.0) return message;
  for (const fusion::CalibratedProperty& p : report.properties) {
    message.properties.push_back({std::string(p.name), std::string(p.unit), p.value, p.sigma,
                                  p.sigma_at_start, p.observed()});
  }
  return message;
}

constexpr auto look_every = std::chrono::milliseconds(1);

bool reaches(const ChannelSpec& channel, const MessageSink& sink) {
  switch (channel.reach) {
    case Reach::everyone:
      return true;
    case Reach::log:
      return sink.wants_raw();
    case Reach::viewers:
      return sink.wants_preview();
  }
  return false;
}

template <const ChannelSpec& channel>
constexpr runtime::TraceName trace_name{channel.name.data()};

}  // namespace

// In this order messages with the same time leave.
Publisher::Publisher(const VehicleCalibration& calibration, Rings& rings,
                     std::vector<MessageSink*> sinks, Observer observer, MatchDescriber in_words)
    : calibration_(calibration),
      rings_(rings),
      reports_(rings.consumer(rings::health_publisher)),
      previews_(rings.consumer(rings::preview_publisher)),
      sinks_(std::move(sinks)),
      observer_(std::move(observer)),
      in_words_(std::move(in_words)) {
  forward<channels::camera>(rings::camera_publisher);
  forward<channels::velodyne>(rings::velodyne_publisher);
  forward<channels::imu>(rings::imu_publisher);
  forward<channels::gnss_fix>(rings::gnss_publisher);
  forward<channels::gnss_fix>(rings::ppp_fix_publisher);
  forward<channels::wheel_speed>(rings::wheel_publisher);
  forward<channels::truth>(rings::reference_publisher);
  forward<channels::visual_odometry>(rings::stereo_publisher, observer_.odometry);
  forward<channels::visual_odometry>(rings::visual_log_publisher, observer_.odometry);
  forward<channels::lidar_odometry>(rings::lidar_publisher, observer_.lidar);
  forward<channels::lidar_odometry>(rings::lidar_log_publisher, observer_.lidar);
  forward<channels::odometry>(rings::lidar_odometry_publisher);
  forward<channels::odometry>(rings::stereo_odometry_publisher);
  forward<channels::odometry>(rings::odometry_publisher);
  forward<channels::ppp_state>(rings::ppp_publisher, observer_.ppp);
  forward<channels::nav_state>(rings::fusion_publisher, observer_.nav_state);
  if (auto* states = rings.consumer(rings::image_states)) {
    intake_.add(*states, [this](const FusedState& state) { observer_.image_state(state); });
  }
  forward<channels::self_calibration>(rings::calibration_publisher, observer_.calibration);
  forward<channels::map_match>(rings::mapmatch_publisher, observer_.map_match);
  forward<channels::map_doubt>(rings::doubt_publisher);
  forward<channels::map_feedback>(rings::feedback_publisher, observer_.map_feedback);
}

template <const ChannelSpec& channel, class T>
void Publisher::forward(const RingSpec<T>& spec, const std::function<void(const T&)>& observe) {
  runtime::Edge<T>* ring = rings_.consumer(spec);
  if (ring == nullptr) return;
  intake_.add(*ring, [this, observe](const T& sample) {
    runtime::TraceSpan span(trace_, trace_name<channel>);
    if constexpr (std::is_same_v<T, FusedState>) end_flows(span, sample);
    // The flow of an image goes on with the odometry that is fused.
    if constexpr (&channel != &channels::visual_odometry && &channel != &channels::lidar_odometry)
      note_flow(sample);
    if constexpr (std::is_same_v<T, MapMatch>) {
      send(channel, sample.available, to_lcm(sample, in_words_(sample)));
    } else if constexpr (std::is_same_v<T, CalibrationReport>) {
      send(channel, sample.available, to_lcm(message_of(sample)));
    } else {
      send(channel, sample.available, to_lcm(sample));
    }
    if constexpr (std::is_same_v<T, FusedState>) {
      send(channels::odom_state, sample.available, to_lcm(sample.odom));
      if (sample.protection)
        send(channels::nav_protection, sample.available, to_lcm(*sample.protection));
    }
    observe(sample);
  });
}

template <class T>
void Publisher::note_flow(const T& sample) {
  if constexpr (requires { flow_of(sample); }) {
    if (trace_ != nullptr) passing_.push_back({flow_of(sample), sample.available});
  }
}

// A state holds exactly what was available by its tick, and everything of that was taken from the
// edges before it.
void Publisher::end_flows(runtime::TraceSpan& span, const NavState& state) {
  std::erase_if(passing_, [&](const Passing& passing) {
    const bool inside = passing.available <= state.stamp;
    if (inside) span.end_flow(passing.flow);
    return inside;
  });
}

template <class Lcm>
void Publisher::send(const ChannelSpec& channel, Time time, const Lcm& message) {
  const MonotonicTime started = runtime::monotonic_now();
  const int size = message.getEncodedSize();
  buffer_.resize(static_cast<std::size_t>(size));
  if (message.encode(buffer_.data(), 0, size) != size) {
    throw std::logic_error("cannot encode a message for " + std::string(channel.name));
  }
  for (MessageSink* sink : sinks_) {
    if (reaches(channel, *sink)) {
      sink->send({channel.name, time, buffer_, channel.from_data});
    }
  }
  meter_.ran(runtime::monotonic_now() - started);
}

void Publisher::send_reports() {
  while (const RuntimeReport* report = reports_->front()) {
    const runtime::TraceSpan span(trace_, trace_name<channels::health>);
    send(channels::health, report->available, to_lcm(report->health));
    send(channels::deadlines, report->available, to_lcm(report->deadlines));
    observer_.health(report->health);
    observer_.place(report->place, report->here);
    reports_->pop();
  }
}

void Publisher::send_previews() {
  while (const Preview* preview = previews_ != nullptr ? previews_->front() : nullptr) {
    const runtime::TraceSpan span(trace_, trace_name<channels::preview>);
    send(channels::preview, preview->available, to_lcm(*preview));
    previews_->pop();
  }
}

void Publisher::run(Time begin, const runtime::DataClock& clock) {
  maploop_lcm::calibration_t calibration = to_lcm(calibration_);
  calibration.utime =
      std::chrono::floor<std::chrono::microseconds>(begin).time_since_epoch().count();
  send(channels::calibration, begin, calibration);
  for (;;) {
    const bool last = intake_.finished() && reports_->promised() == Time::max();
    const Time given_up = clock.is_live() ? clock.now() - patience : Time::min();
    intake_.take_until(std::max(intake_.promised(), given_up));
    send_previews();
    send_reports();
    if (last) return;
    std::this_thread::sleep_for(look_every);
  }
}

void Publisher::finish() {
  intake_.abandon();
  reports_->abandon();
  for (MessageSink* sink : sinks_) sink->flush();
}

}  // namespace maploop::vehicle
