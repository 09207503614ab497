#include "runtime/vehicle/ppp_stage.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include "ppp/epoch_state.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/trace_flows.h"

namespace maploop::vehicle {
namespace {

constexpr auto relaxed = std::memory_order_relaxed;

// Satellites that a receiver of all systems sees at most; more is no error.
constexpr std::size_t usual_satellites = 64;

// What the receiver hears is added to what the files had.
std::optional<ppp::CorrectedEphemeris> grows(const ppp::PppSetup& setup) {
  if (!setup.live() || setup.precise()) return {};
  return ppp::CorrectedEphemeris(*setup.broadcast());
}

}  // namespace

PppEdges::PppEdges(bool closed, bool corrected)
    : epochs(make_edge<GnssEpoch>(edges::gnss_ppp, &bell)) {
  const auto add = [this](auto& edge, const EdgeSpec& spec) {
    edge.emplace(std::string(spec.name), spec.capacity, spec.overflow, &bell);
  };
  if (closed) add(feedback, edges::mapmatch_ppp);
  if (corrected) add(corrections, edges::corrections_ppp);
}

PppStage::PppStage(std::shared_ptr<const ppp::PppSetup> setup, double integrity_risk,
                   PppEdges& inputs, runtime::Edge<PppState>& states,
                   std::vector<runtime::Edge<GnssFix>*> fixes)
    : setup_(std::move(setup)),
      received_(grows(*setup_)),
      filter_(setup_->make_map_aided_filter(received_ ? &*received_ : nullptr)),
      integrity_risk_(integrity_risk),
      inputs_(inputs),
      states_(states),
      fixes_(std::move(fixes)),
      meter_(stages::ppp) {
  state_.satellites.reserve(usual_satellites);
  free_state_.satellites.reserve(usual_satellites);
  held_.reserve(edges::mapmatch_ppp.capacity);
}

void PppStage::run(const runtime::DataClock& clock, const std::stop_token& stop) {
  for (Sent& sent : sent_) send(sent, stop);  // of the run that this one resumes
  while (!stop.stop_requested()) {
    const std::uint32_t heard = inputs_.bell.listen();
    // Promises before the rings: see EdgeBase::promised().
    const Time promised = inputs_.epochs.promised();
    const bool waits = inputs_.feedback && !clock.is_live();
    const Time known = waits ? inputs_.feedback->promised() : Time::max();
    hold_feedback();
    take_corrections();
    const GnssEpoch* epoch = inputs_.epochs.front();
    if (epoch != nullptr && known >= epoch->available) {
      save_until(epoch->available - Duration(1), stop);
      take(*epoch, clock, stop);
      inputs_.epochs.pop();
      continue;
    }
    if (epoch != nullptr) {
      // Its state is available a budget later: until then nobody waits for it.
      promise(epoch->available + stages::ppp.budget - Duration(1));
    } else if (promised == Time::max()) {
      save_until(promised, stop);
      break;
    } else {
      save_until(std::min(promised, known), stop);
      promise(promised + stages::ppp.budget);
    }
    inputs_.bell.wait(heard);
  }
  drain_feedback(stop);
}

void PppStage::take(const GnssEpoch& epoch, const runtime::DataClock& clock,
                    const std::stop_token& stop) {
  const MonotonicTime started = runtime::monotonic_now();
  process(epoch, stop);
  const MonotonicTime ended = runtime::monotonic_now();
  const bool missed = meter_.worked({epoch.stamp, epoch.received, started, ended,
                                     cuts_.held_up(epoch.received, "busy with the epoch before")},
                                    clock.keeps_time(epoch.available));
  if (missed) runtime::trace_instant(trace_, "missed deadline");
}

// What says nothing is passed over, so that the ring is never full.
void PppStage::hold_feedback() {
  if (!inputs_.feedback) return;
  while (const MapFeedback* f = inputs_.feedback->front()) {
    if (f->position || f->azimuth || f->reason == FeedbackReason::inconsistent) held_.push_back(*f);
    inputs_.feedback->pop();
  }
}

// On the road alone: whatever has come by now.
void PppStage::take_corrections() {
  if (!inputs_.corrections) return;
  while (const GnssCorrections* c = inputs_.corrections->front()) {
    if (received_) {
      received_->add(c->heard);
      for (const ppp::SsrUpdate& u : c->updates) received_->add(u);
    }
    inputs_.corrections->pop();
  }
}

// What of the epoch is corrected, and by how old corrections.
void PppStage::say_corrections() {
  if (!inputs_.corrections || !received_) return;
  const auto age = received_->age();
  for (PppState* state : {&state_, &free_state_}) {
    state->satellites_corrected = 0;
    if (age) state->correction_age = to_seconds(*age);
    for (const PppSatellite& s : state->satellites) {
      const auto system = ppp::system_of(s.system);
      state->satellites_corrected += system && received_->corrected({*system, s.number});
    }
  }
  if (state_.satellites_corrected == 0) counts_.uncorrected.fetch_add(1, relaxed);
  counts_.correction_age.store(state_.correction_age.value_or(-1.0), relaxed);
  const std::string what = wrong_with_corrections();
  if (what.empty()) return;
  for (PppState* state : {&state_, &free_state_}) {
    state->message += (state->message.empty() ? "" : "; ") + what;
  }
}

std::string PppStage::wrong_with_corrections() const {
  const double age = counts_.correction_age.load(relaxed);
  if (!inputs_.corrections) return {};
  if (age < 0.0) return "ppp: no corrections have come: broadcast orbits and clocks";
  if (age <= to_seconds(ppp::CorrectedEphemeris::longest_age)) return {};
  return "ppp: corrections are " + std::to_string(std::lround(age)) +
         " s old: broadcast orbits and clocks";
}

void PppStage::look_at_ionosphere(ppp::GpsTime t) {
  if (!setup_->one_frequency()) return;
  const auto age = received_             ? received_->ionosphere().age(t)
                   : setup_->broadcast() ? setup_->broadcast()->ionosphere().age(t)
                                         : std::nullopt;
  counts_.age_of_ionosphere.store(age.value_or(Duration::max()), relaxed);
}

std::string PppStage::degraded() const {
  const Duration age = counts_.age_of_ionosphere.load(relaxed);
  const std::string ionosphere =
      ppp::ionosphere_lack(age == Duration::max() ? std::nullopt : std::optional(age));
  std::string what = wrong_with_corrections();
  if (!ionosphere.empty()) what += (what.empty() ? "ppp: " : "; ") + ionosphere;
  return what;
}

// There are no more epochs; the matcher must not wait for a full ring.
void PppStage::drain_feedback(const std::stop_token& stop) {
  promise(Time::max());
  while (inputs_.feedback && !stop.stop_requested()) {
    const std::uint32_t heard = inputs_.bell.listen();
    const Time known = inputs_.feedback->promised();
    while (inputs_.feedback->front() != nullptr) inputs_.feedback->pop();
    if (known == Time::max()) return;
    inputs_.bell.wait(heard);
  }
}

// About the last epoch; what is of the next one is kept for it. The filter knows the receiver's
// time alone, which on the road is not the host's.
void PppStage::use_feedback(Time until) {
  const Duration reach = from_seconds(filter_.parameters().map_reach);
  std::erase_if(held_, [&](MapFeedback& f) {
    if (f.available > until || f.stamp > last_epoch_ + reach) return false;
    f.stamp += receiver_ahead_;
    filter_.add(f);
    return true;
  });
}

void PppStage::process(const GnssEpoch& epoch, const std::stop_token& stop) {
  runtime::TraceSpan span(trace_, "ppp");
  span.step_flow(flow_of(epoch));
  delay_(epoch.available);
  if (last_epoch_ != Time::min()) use_feedback(epoch.available);
  if (received_) {
    received_->add(epoch.heard);
    received_->begin(epoch.epoch.time);
  }
  ppp::describe(filter_.process(epoch.epoch), integrity_risk_, state_);
  ppp::describe_map(filter_, state_);
  ppp::describe(filter_.map_free(), integrity_risk_, free_state_);
  last_epoch_ = epoch.stamp;
  receiver_ahead_ = ppp::to_utc(epoch.epoch.time) - epoch.stamp;
  for (PppState* state : {&state_, &free_state_}) {
    state->stamp = epoch.stamp;
    state->available = epoch.available + stages::ppp.budget;
    state->sequence = epoch.sequence;
  }
  say_corrections();
  look_at_ionosphere(epoch.epoch.time);
  count(state_);
  use_.note(epoch.available, state_.status == PppStatus::none ? "no position" : nullptr);
  std::erase_if(sent_, [&](const Sent& s) { return s.state.available <= epoch.available; });
  sent_.push_back({state_, free_state_.status != PppStatus::none, ppp::to_fix(free_state_)});
  send(sent_.back(), stop);
  use_feedback(epoch.available);
}

void PppStage::count(const PppState& state) {
  for (const PppSatellite& s : state.satellites) {
    counts_.refused[static_cast<std::size_t>(s.refusal)].fetch_add(1, relaxed);
    counts_.slipped[static_cast<std::size_t>(s.slip)].fetch_add(1, relaxed);
  }
  if (state.status == PppStatus::none) counts_.without_position.fetch_add(1, relaxed);
  counts_.restarts.store(state.restarts, relaxed);
  counts_.forgotten_roads.store(filter_.restorations(), relaxed);
}

void PppStage::send(Sent& sent, const std::stop_token& stop) {
  sent.state.received = sent.fix.received = runtime::monotonic_now();
  states_.push(sent.state, stop);
  if (sent.has_fix) {
    for (auto* edge : fixes_) edge->push(sent.fix, stop);
  }
  promise(sent.state.available);
}

void PppStage::save_until(Time t, const std::stop_token& stop) {
  const auto promise_until = [this](Time cut) { promise(cut); };
  cuts_.save_until(t, stop, promise_until, [this](ArchiveWriter& ar, Time cut) {
    std::erase_if(sent_, [cut](const Sent& s) { return s.state.available <= cut; });
    describe(ar, *this, cut);
  });
}

// With the results that become available after the cut: whoever goes on from there sends them.
template <class Archive, class Stage>
void PppStage::describe(Archive& ar, Stage& stage, Time cut) {
  ar.section(stages::ppp.name, 3);
  std::array<std::uint64_t, ppp_refusal_count> refused{};
  std::array<std::uint64_t, ppp_slip_count> slipped{};
  std::uint64_t without_position = stage.counts_.without_position;
  std::uint64_t restarts = stage.counts_.restarts;
  std::copy(stage.counts_.refused.begin(), stage.counts_.refused.end(), refused.begin());
  std::copy(stage.counts_.slipped.begin(), stage.counts_.slipped.end(), slipped.begin());
  std::uint64_t forgotten_roads = stage.counts_.forgotten_roads;
  // What becomes available after the cut, the matcher that goes on from there sends.
  std::vector<MapFeedback> held;
  std::copy_if(stage.held_.begin(), stage.held_.end(), std::back_inserter(held),
               [cut](const MapFeedback& f) { return f.available <= cut; });
  ar(stage.filter_, refused, slipped, without_position, restarts, forgotten_roads, stage.sent_,
     held, stage.last_epoch_);
  if constexpr (Archive::loading) {
    std::copy(refused.begin(), refused.end(), stage.counts_.refused.begin());
    std::copy(slipped.begin(), slipped.end(), stage.counts_.slipped.begin());
    stage.counts_.without_position = without_position;
    stage.counts_.restarts = restarts;
    stage.counts_.forgotten_roads = forgotten_roads;
    stage.held_ = std::move(held);
  }
}

std::size_t PppStage::saved_bytes() {
  return ppp::MapAidedFilter::largest_archive + 2 * usual_satellites * sizeof(PppSatellite) + 4096;
}

void PppStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this, Time::max());
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
  add("a wrong road forgotten", counts_.forgotten_roads.load(relaxed));
  add("epoch without corrections", counts_.uncorrected.load(relaxed));
  return all;
}

void PppStage::promise(Time t) {
  states_.promise(t);
  for (auto* edge : fixes_) edge->promise(t);
}

void PppStage::finish() {
  promise(Time::max());
  cuts_.finish();
  inputs_.epochs.abandon();
  if (inputs_.feedback) inputs_.feedback->abandon();
  if (inputs_.corrections) inputs_.corrections->abandon();
}

}  // namespace maploop::vehicle
