// The ppp thread: precise point positioning at each epoch of the GNSS receiver.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "msgs/diagnostics.h"
#include "msgs/gnss.h"
#include "msgs/ppp_state.h"
#include "ppp/ppp_setup.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/gnss_epoch.h"
#include "runtime/vehicle/stage_cuts.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// The edge that ends at the ppp thread.
struct PppEdges {
  PppEdges();

  runtime::Doorbell bell;
  runtime::Edge<GnssEpoch> epochs;
};

class PppStage {
 public:
  // A fix of each epoch that has a position goes to all of `fixes`.
  PppStage(std::shared_ptr<const ppp::PppSetup> setup, double integrity_risk, PppEdges& inputs,
           runtime::Edge<PppState>& states, std::vector<runtime::Edge<GnssFix>*> fixes);

  // Until the epochs are finished or stop is requested.
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

  const ThreadMeter& meter() const { return meter_; }
  // Epochs without a position, satellites refused and slips by their reasons, and restarts, so far;
  // any thread may ask.
  std::vector<RefusalCount> refusals() const;

 private:
  void process(const GnssEpoch& epoch, const std::stop_token& stop);
  void count(const PppState& state);
  void send(PppState& state, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  template <class Archive, class Stage>
  static void describe(Archive& ar, Stage& stage);
  void promise(Time t);

  struct Counts {
    std::array<std::atomic<std::uint64_t>, ppp_refusal_count> refused{};
    std::array<std::atomic<std::uint64_t>, ppp_slip_count> slipped{};
    std::atomic<std::uint64_t> without_position{0};
    std::atomic<std::uint64_t> restarts{0};
  };

  std::shared_ptr<const ppp::PppSetup> setup_;  // what the filter looks at
  ppp::PppFilter filter_;
  double integrity_risk_;
  PppEdges& inputs_;
  runtime::Edge<PppState>& states_;
  std::vector<runtime::Edge<GnssFix>*> fixes_;
  ThreadMeter meter_;
  runtime::TraceBuffer* trace_ = nullptr;
  StageDelay delay_;
  StageCuts cuts_;
  PppState state_;              // of the last epoch, to reuse its memory
  std::vector<PppState> sent_;  // those that were not yet available at the last epoch
  Counts counts_;
};

}  // namespace maploop::vehicle
