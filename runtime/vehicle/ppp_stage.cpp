#include "runtime/vehicle/ppp_stage.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "ppp/epoch_state.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/take_each.h"
#include "runtime/vehicle/trace_flows.h"

namespace maploop::vehicle {
namespace {

constexpr auto relaxed = std::memory_order_relaxed;

// Satellites that a receiver of all systems sees at most; more is no error.
constexpr std::size_t usual_satellites = 64;

}  // namespace

PppEdges::PppEdges() : epochs(make_edge<GnssEpoch>(edges::gnss_ppp, &bell)) {}

PppStage::PppStage(std::shared_ptr<const ppp::PppSetup> setup, double integrity_risk,
                   PppEdges& inputs, runtime::Edge<PppState>& states,
                   std::vector<runtime::Edge<GnssFix>*> fixes)
    : setup_(std::move(setup)),
      filter_(setup_->make_filter()),
      integrity_risk_(integrity_risk),
      inputs_(inputs),
      states_(states),
      fixes_(std::move(fixes)),
      meter_(stages::ppp) {
  state_.satellites.reserve(usual_satellites);
}

void PppStage::run(const runtime::DataClock& clock, const std::stop_token& stop) {
  for (PppState& state : sent_) send(state, stop);  // of the run that this one resumes
  const auto take = [&](const GnssEpoch& epoch) {
    const MonotonicTime started = runtime::monotonic_now();
    process(epoch, stop);
    const MonotonicTime ended = runtime::monotonic_now();
    const bool missed =
        meter_.worked({epoch.stamp, epoch.received, started, ended, "busy with the epoch before"},
                      clock.keeps_time(epoch.available));
    if (missed) runtime::trace_instant(trace_, "missed deadline");
  };
  take_each(
      inputs_.epochs, inputs_.bell, stages::ppp.budget, stop, take,
      [&](Time t) { save_until(t, stop); }, [this](Time t) { promise(t); });
}

void PppStage::process(const GnssEpoch& epoch, const std::stop_token& stop) {
  runtime::TraceSpan span(trace_, "ppp");
  span.step_flow(flow_of(epoch));
  delay_(epoch.available);
  ppp::describe(filter_.process(epoch.epoch), integrity_risk_, state_);
  state_.stamp = epoch.stamp;
  state_.available = epoch.available + stages::ppp.budget;
  state_.sequence = epoch.sequence;
  count(state_);
  std::erase_if(sent_, [&](const PppState& s) { return s.available <= epoch.available; });
  sent_.push_back(state_);
  send(state_, stop);
}

void PppStage::count(const PppState& state) {
  for (const PppSatellite& s : state.satellites) {
    counts_.refused[static_cast<std::size_t>(s.refusal)].fetch_add(1, relaxed);
    counts_.slipped[static_cast<std::size_t>(s.slip)].fetch_add(1, relaxed);
  }
  if (state.status == PppStatus::none) counts_.without_position.fetch_add(1, relaxed);
  counts_.restarts.store(state.restarts, relaxed);
}

void PppStage::send(PppState& state, const std::stop_token& stop) {
  state.received = runtime::monotonic_now();
  states_.push(state, stop);
  if (state.status != PppStatus::none) {
    GnssFix fix = ppp::to_fix(state);
    fix.received = state.received;
    for (auto* edge : fixes_) edge->push(fix, stop);
  }
  promise(state.available);
}

void PppStage::save_until(Time t, const std::stop_token& stop) {
  const auto promise_until = [this](Time cut) { promise(cut); };
  cuts_.save_until(t, stop, promise_until, [this](ArchiveWriter& ar, Time cut) {
    std::erase_if(sent_, [cut](const PppState& s) { return s.available <= cut; });
    describe(ar, *this);
  });
}

// With the results that become available after the cut: whoever goes on from there sends them.
template <class Archive, class Stage>
void PppStage::describe(Archive& ar, Stage& stage) {
  ar.section(stages::ppp.name, 1);
  std::array<std::uint64_t, ppp_refusal_count> refused{};
  std::array<std::uint64_t, ppp_slip_count> slipped{};
  std::uint64_t without_position = stage.counts_.without_position;
  std::uint64_t restarts = stage.counts_.restarts;
  std::copy(stage.counts_.refused.begin(), stage.counts_.refused.end(), refused.begin());
  std::copy(stage.counts_.slipped.begin(), stage.counts_.slipped.end(), slipped.begin());
  ar(stage.filter_, refused, slipped, without_position, restarts, stage.sent_);
  if constexpr (Archive::loading) {
    std::copy(refused.begin(), refused.end(), stage.counts_.refused.begin());
    std::copy(slipped.begin(), slipped.end(), stage.counts_.slipped.begin());
    stage.counts_.without_position = without_position;
    stage.counts_.restarts = restarts;
  }
}

std::size_t PppStage::saved_bytes() {
  return ppp::PppFilter::largest_archive + 2 * usual_satellites * sizeof(PppSatellite) + 4096;
}

void PppStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this);
  ar.finish();
}

std::vector<RefusalCount> PppStage::refusals() const {
  std::vector<RefusalCount> all;
  const auto add = [&](std::string_view reason, std::uint64_t count) {
    if (count > 0) all.push_back({std::string(stages::ppp.name), std::string(reason), count});
  };
  add("epoch without a position", counts_.without_position.load(relaxed));
  for (std::size_t i = 1; i < ppp_refusal_count; ++i) {
    add(to_string(static_cast<PppRefusal>(i)), counts_.refused[i].load(relaxed));
  }
  for (std::size_t i = 1; i < ppp_slip_count; ++i) {
    const std::string slip(to_string(static_cast<PppSlip>(i)));
    add("slip: " + slip, counts_.slipped[i].load(relaxed));
  }
  add("begun anew: measurements disagreed with the position", counts_.restarts.load(relaxed));
  return all;
}

void PppStage::promise(Time t) {
  states_.promise(t);
  for (auto* edge : fixes_) edge->promise(t);
}

void PppStage::finish() {
  promise(Time::max());
  cuts_.finish();
}

}  // namespace maploop::vehicle
