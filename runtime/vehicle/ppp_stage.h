// The ppp thread: precise point positioning at each epoch of the GNSS receiver.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "msgs/diagnostics.h"
#include "msgs/gnss.h"
#include "msgs/map_feedback.h"
#include "msgs/ppp_state.h"
#include "ppp/ppp_setup.h"
#include "ppp/products/corrected.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/episodes.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/gnss_epoch.h"
#include "runtime/vehicle/live_corrections.h"
#include "runtime/vehicle/stage_cuts.h"
#include "runtime/vehicle/thread_meter.h"
#include "runtime/vehicle/watchdog.h"

namespace maploop::vehicle {

// The edges that end at the ppp thread.
struct PppEdges {
  // `closed`: the map feeds back; `corrected`: a stream of corrections comes.
  explicit PppEdges(bool closed = false, bool corrected = false);

  runtime::Doorbell bell;
  runtime::Edge<GnssEpoch> epochs;
  std::optional<runtime::Edge<MapFeedback>> feedback;
  std::optional<runtime::Edge<GnssCorrections>> corrections;
};

class PppStage {
 public:
  // A fix of each epoch that has a position goes to all of `fixes`: of the filter without the map.
  // Whoever takes it gets the map's feedback himself, and would else count it twice.
  PppStage(std::shared_ptr<const ppp::PppSetup> setup, double integrity_risk, PppEdges& inputs,
           runtime::Edge<PppState>& states, std::vector<runtime::Edge<GnssFix>*> fixes);

  // Until the epochs are finished or stop is requested. An epoch takes the feedback that is
  // available by then; on a live clock, what of it is there.
  void run(const runtime::DataClock& clock, const std::stop_token& stop);
  void finish();

  // Before run().
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }
  void save_at(std::vector<Time> moments, runtime::Edge<StageSnapshot>& edge) {
    cuts_.set(std::move(moments), edge);
  }
  // Memory that what it saves usually takes at most.
  static std::size_t saved_bytes();
  // Goes on from what was saved; throws ArchiveError, as PppFilter.
  void resume(std::span<const std::uint8_t> saved);

  UseWatch& use() { return use_; }
  const ThreadMeter& meter() const { return meter_; }
  // Epochs without a position, satellites refused and slips by their reasons, and restarts, so far;
  // any thread may ask.
  std::vector<RefusalCount> refusals() const;
  // What is wrong with the corrections and the ionosphere's coefficients at the last epoch, as a
  // sentence; empty: nothing. Any thread may ask.
  std::string degraded() const;

 private:
  // Of an epoch.
  struct Sent {
    PppState state;
    bool has_fix = false;
    GnssFix fix;
    template <class Archive>
    void archive(Archive& ar) {
      ar(state, has_fix, fix);
    }
  };

  void take(const GnssEpoch& epoch, const runtime::DataClock& clock, const std::stop_token& stop);
  void hold_feedback();
  void take_corrections();
  void say_corrections();
  std::string wrong_with_corrections() const;
  void look_at_ionosphere(ppp::GpsTime t);
  void drain_feedback(const std::stop_token& stop);
  void use_feedback(Time until);
  void process(const GnssEpoch& epoch, const std::stop_token& stop);
  void count(const PppState& state);
  void send(Sent& sent, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  template <class Archive, class Stage>
  static void describe(Archive& ar, Stage& stage, Time cut);
  void promise(Time t);

  struct Counts {
    std::array<std::atomic<std::uint64_t>, ppp_refusal_count> refused{};
    std::array<std::atomic<std::uint64_t>, ppp_slip_count> slipped{};
    std::atomic<std::uint64_t> without_position{0};
    std::atomic<std::uint64_t> restarts{0};
    std::atomic<std::uint64_t> forgotten_roads{0};
    std::atomic<std::uint64_t> uncorrected{0};  // epochs, where corrections are received
    std::atomic<double> correction_age{0.0};    // s; negative: none ever came
    // With one frequency; Duration::max(): there are none.
    std::atomic<Duration> age_of_ionosphere{Duration::zero()};
  };

  std::shared_ptr<const ppp::PppSetup> setup_;       // what the filter looks at
  std::optional<ppp::CorrectedEphemeris> received_;  // of a live receiver without precise orbits
  ppp::MapAidedFilter filter_;
  double integrity_risk_;
  PppEdges& inputs_;
  runtime::Edge<PppState>& states_;
  std::vector<runtime::Edge<GnssFix>*> fixes_;
  UseWatch use_{stages::ppp.name, "epochs", Watchdog::patience(stages::ppp)};
  ThreadMeter meter_;
  runtime::TraceBuffer* trace_ = nullptr;
  StageDelay delay_;
  StageCuts cuts_;
  PppState state_, free_state_;    // of the last epoch, to reuse their memory
  std::vector<Sent> sent_;         // those that were not yet available at the last epoch
  std::vector<MapFeedback> held_;  // not yet used
  Time last_epoch_ = Time::min();  // its stamp
  Duration receiver_ahead_{};      // its clock before that of stamps
  Counts counts_;
};

}  // namespace maploop::vehicle
