#include "runtime/vehicle/publisher.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "msgs/lcm/conversions.h"
#include "msgs/lcm/raw_conversions.h"
#include "runtime/vehicle/trace_flows.h"

namespace maploop::vehicle {
namespace {

constexpr auto look_every = std::chrono::milliseconds(1);

bool reaches(const Channel& channel, const MessageSink& sink) {
  switch (channel.reach) {
    case Reach::everyone:
      return true;
    case Reach::log:
      return sink.wants_raw();
    case Reach::lookers:
      return sink.wants_preview();
  }
  return false;
}

consteval runtime::TraceName trace_name(const Channel& channel) {
  return channel.name.data();
}

}  // namespace

PublisherEdges::PublisherEdges()
    : camera(make_edge<StereoPair>(edges::camera_publisher, nullptr)),
      velodyne(make_edge<LidarScan>(edges::velodyne_publisher, nullptr)),
      imu(make_edge<ImuSample>(edges::imu_publisher, nullptr)),
      gnss(make_edge<GnssFix>(edges::gnss_publisher, nullptr)),
      wheel(make_edge<WheelSpeed>(edges::wheel_publisher, nullptr)),
      reference(make_edge<ReferencePose>(edges::reference_publisher, nullptr)),
      visual(make_edge<RelativeMotion>(edges::stereo_publisher, nullptr)),
      lidar(make_edge<LidarMotion>(edges::lidar_publisher, nullptr)),
      odometry(make_edge<RelativeMotion>(edges::odometry_publisher, nullptr)),
      ppp(make_edge<PppState>(edges::ppp_publisher, nullptr)),
      nav_state(make_edge<NavState>(edges::fusion_publisher, nullptr)),
      image_state(make_edge<NavState>(edges::image_states, nullptr)),
      map_match(make_edge<MapMatch>(edges::mapmatch_publisher, nullptr)),
      map_feedback(make_edge<MapFeedback>(edges::feedback_publisher, nullptr)),
      preview(make_edge<Preview>(edges::preview_publisher, nullptr)),
      reports(make_edge<RuntimeReport>(edges::health_publisher, nullptr)) {}

Publisher::Publisher(const VehicleCalibration& calibration, PublisherEdges& edges,
                     std::vector<MessageSink*> sinks, Observer observer, MatchDescriber in_words)
    : calibration_(calibration),
      edges_(edges),
      sinks_(std::move(sinks)),
      observer_(std::move(observer)),
      in_words_(std::move(in_words)) {
  forward<channels::camera>(edges_.camera);
  forward<channels::velodyne>(edges_.velodyne);
  forward<channels::imu>(edges_.imu);
  forward<channels::gnss_fix>(edges_.gnss);
  forward<channels::wheel_speed>(edges_.wheel);
  forward<channels::truth>(edges_.reference);
  intake_.add(edges_.visual, [this](const RelativeMotion& motion) {
    const runtime::TraceSpan span(trace_, trace_name(channels::visual_odometry));
    send(channels::visual_odometry, motion.available, to_lcm(motion));
    observer_.odometry(motion);
  });
  intake_.add(edges_.lidar, [this](const LidarMotion& motion) {
    const runtime::TraceSpan span(trace_, trace_name(channels::lidar_odometry));
    send(channels::lidar_odometry, motion.available, to_lcm(motion));
    observer_.lidar(motion);
  });
  intake_.add(edges_.odometry, [this](const RelativeMotion& motion) {
    const runtime::TraceSpan span(trace_, trace_name(channels::odometry));
    note_flow(motion);
    send(channels::odometry, motion.available, to_lcm(motion));
  });
  intake_.add(edges_.ppp, [this](const PppState& state) {
    const runtime::TraceSpan span(trace_, trace_name(channels::ppp_state));
    send(channels::ppp_state, state.available, to_lcm(state));
    observer_.ppp(state);
  });
  intake_.add(edges_.nav_state, [this](const NavState& state) {
    runtime::TraceSpan span(trace_, trace_name(channels::nav_state));
    end_flows(span, state);
    send(channels::nav_state, state.available, to_lcm(state));
    observer_.nav_state(state);
  });
  intake_.add(edges_.image_state, [this](const NavState& state) { observer_.image_state(state); });
  intake_.add(edges_.map_match, [this](const MapMatch& match) {
    const runtime::TraceSpan span(trace_, trace_name(channels::map_match));
    send(channels::map_match, match.available, to_lcm(match, in_words_(match)));
    observer_.map_match(match);
  });
  intake_.add(edges_.map_feedback, [this](const MapFeedback& feedback) {
    const runtime::TraceSpan span(trace_, trace_name(channels::map_feedback));
    send(channels::map_feedback, feedback.available, to_lcm(feedback));
    observer_.map_feedback(feedback);
  });
}

template <const Channel& channel, class T>
void Publisher::forward(runtime::Edge<T>& edge) {
  intake_.add(edge, [this](const T& sample) {
    const runtime::TraceSpan span(trace_, trace_name(channel));
    note_flow(sample);
    send(channel, sample.available, to_lcm(sample));
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
void Publisher::send(const Channel& channel, Time time, const Lcm& message) {
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
  while (const RuntimeReport* report = edges_.reports.front()) {
    const runtime::TraceSpan span(trace_, trace_name(channels::health));
    send(channels::health, report->available, to_lcm(report->health));
    send(channels::deadlines, report->available, to_lcm(report->deadlines));
    observer_.health(report->health);
    edges_.reports.pop();
  }
}

void Publisher::send_previews() {
  while (const Preview* preview = edges_.preview.front()) {
    const runtime::TraceSpan span(trace_, trace_name(channels::preview));
    send(channels::preview, preview->available, to_lcm(*preview));
    edges_.preview.pop();
  }
}

void Publisher::run(Time begin, const runtime::DataClock& clock) {
  maploop_lcm::calibration_t calibration = to_lcm(calibration_);
  calibration.utime =
      std::chrono::floor<std::chrono::microseconds>(begin).time_since_epoch().count();
  send(channels::calibration, begin, calibration);
  for (;;) {
    const bool last = intake_.finished() && edges_.reports.promised() == Time::max();
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
  edges_.reports.abandon();
  for (MessageSink* sink : sinks_) sink->flush();
}

}  // namespace maploop::vehicle
