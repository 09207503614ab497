// Encodes what the graph produces and hands it to the bus, the log and the hashes.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "estimators/fusion/last_place.h"
#include "msgs/calibration.h"
#include "msgs/diagnostics.h"
#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/map_feedback.h"
#include "msgs/map_match.h"
#include "msgs/odom_state.h"
#include "msgs/odometry.h"
#include "msgs/ppp_state.h"
#include "msgs/preview.h"
#include "msgs/reference.h"
#include "msgs/wheel_speed.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/core/intake.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/graph/channel_specs.h"
#include "runtime/vehicle/graph/rings.h"
#include "runtime/vehicle/health/thread_meter.h"
#include "runtime/vehicle/output/message_sink.h"

namespace maploop::vehicle {

// Called on the publisher's thread with each result, for users of values rather than messages.
// `image_state` is the fused state at the moment of each image, with that image's odometry applied.
struct Observer {
  std::function<void(const RelativeMotion&)> odometry = [](const RelativeMotion&) {};
  std::function<void(const LidarMotion&)> lidar = [](const LidarMotion&) {};
  std::function<void(const PppState&)> ppp = [](const PppState&) {};
  std::function<void(const FusedState&)> nav_state = [](const FusedState&) {};
  std::function<void(const FusedState&)> image_state = [](const FusedState&) {};
  std::function<void(const MapMatch&)> map_match = [](const MapMatch&) {};
  std::function<void(const MapFeedback&)> map_feedback = [](const MapFeedback&) {};
  std::function<void(const Health&)> health = [](const Health&) {};
  std::function<void(const CalibrationReport&)> calibration = [](const CalibrationReport&) {};
  // What became of the last place, and where the vehicle is for the next run.
  std::function<void(fusion::PlaceUse, const std::optional<fusion::LastPlace>&)> place =
      [](fusion::PlaceUse, const std::optional<fusion::LastPlace>&) {};
};

// What a match means in words.
using MatchDescriber = std::function<MapMatchWords(const MapMatch&)>;

// One thread's own. Messages of all channels leave in the order of their `available`, but for those
// that come later than a live run waits for them.
class Publisher {
 public:
  Publisher(const VehicleCalibration& calibration, Rings& rings, std::vector<MessageSink*> sinks,
            Observer observer, MatchDescriber in_words);

  const std::vector<MessageSink*>& sinks() const { return sinks_; }

  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }  // before run()

  // Says the calibration at `begin`, then whatever comes, until every edge is finished and empty.
  // On a live clock no longer than `patience` for a stage that hangs.
  void run(Time begin, const runtime::DataClock& clock);
  static constexpr Duration patience = milliseconds(500);
  // It takes nothing more, also after a failure, and what it sent is out.
  void finish();

  // How long sending each message took.
  const ThreadMeter& meter() const { return meter_; }

 private:
  template <class Lcm>
  void send(const ChannelSpec& channel, Time time, const Lcm& message);
  // Sends each sample of the ring on `channel`, and gives it to `observe`.
  template <const ChannelSpec& channel, class T>
  void forward(
      const RingSpec<T>& spec, const std::function<void(const T&)>& observe = [](const T&) {});
  void send_reports();
  void send_previews();
  template <class T>
  void note_flow(const T& sample);
  void end_flows(runtime::TraceSpan& span, const NavState& state);

  VehicleCalibration calibration_;
  Rings& rings_;
  runtime::Edge<RuntimeReport>* reports_;
  runtime::Edge<Preview>* previews_;  // nullptr: none are made
  std::vector<MessageSink*> sinks_;
  Observer observer_;
  MatchDescriber in_words_;
  runtime::Intake intake_;
  std::vector<std::uint8_t> buffer_;
  ThreadMeter meter_{stages::publisher};

  // Samples on their way through the fusion, while a trace is recorded.
  struct Passing {
    runtime::TraceFlow flow;
    Time available;
  };
  runtime::TraceBuffer* trace_ = nullptr;
  std::vector<Passing> passing_;
};

}  // namespace maploop::vehicle
