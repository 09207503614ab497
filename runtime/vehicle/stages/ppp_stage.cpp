#include "runtime/vehicle/stages/ppp_stage.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include "ppp/epoch_state.h"
#include "ppp/increment.h"
#include "runtime/vehicle/graph/trace_flows.h"

namespace maploop::vehicle {
namespace {

constexpr auto relaxed = std::memory_order_relaxed;
// The filter of an earlier run is used for so long.
constexpr Duration longest_away = std::chrono::minutes(10);

// A live receiver without precise products adds what it receives to the broadcast ephemeris.
std::optional<ppp::CorrectedEphemeris> grows(const ppp::PppSetup& setup) {
  if (!setup.live() || setup.precise()) return {};
  return ppp::CorrectedEphemeris(*setup.broadcast());
}

}  // namespace

PppStage::PppStage(Rings& rings, std::shared_ptr<const ppp::PppSetup> setup, double integrity_risk,
                   const fusion::FusionParameters& antenna)
    : GraphStage(stages::ppp, rings),
      setup_(std::move(setup)),
      received_(grows(*setup_)),
      filter_(setup_->make_map_aided_filter(received_ ? &*received_ : nullptr)),
      integrity_risk_(integrity_risk),
      epochs_(*input(rings::gnss_ppp)),
      feedback_(input(rings::mapmatch_ppp)),
      motion_(input(rings::fusion_ppp)),
      corrections_(input(rings::corrections_ppp)),
      states_(outputs(rings::ppp_publisher)),
      fixes_(outputs(rings::ppp_fusion, rings::ppp_fix_publisher)),
      track_(antenna) {
  state_.satellites.reserve(ppp::usual_satellites);
  free_state_.satellites.reserve(ppp::usual_satellites);
  held_.reserve(rings::mapmatch_ppp.capacity);
}

void PppStage::run(runtime::DataClock& clock, Time, const std::stop_token& stop) {
  for (Sent& sent : sent_) send(sent, stop);  // of the run that this one resumes
  while (!stop.stop_requested()) {
    const std::uint32_t heard = bell().listen();
    // Promises before the rings: see EdgeBase::promised().
    const Time promised = epochs_.promised();
    const Time known = clock.is_live() ? Time::max() : this->known();
    hold_feedback();
    hold_motion();
    take_corrections();
    const GnssEpoch* epoch = epochs_.front();
    if (epoch != nullptr && known >= epoch->available) {
      save_until(epoch->available - Duration(1), stop);
      take(*epoch, clock, stop);
      epochs_.pop();
      continue;
    }
    // Nothing comes until then. A cut must not wait for an epoch: the stages before it wait for it.
    const Time quiet = epoch != nullptr ? epoch->available - Duration(1) : promised;
    save_until(quiet == Time::max() ? quiet : std::min(quiet, known), stop);
    if (quiet == Time::max()) break;
    promise(quiet + spec().budget);
    bell().wait(heard);
  }
  drain_inputs(stop);
}

void PppStage::take(const GnssEpoch& epoch, const runtime::DataClock& clock,
                    const std::stop_token& stop) {
  const MonotonicTime started = runtime::monotonic_now();
  process(epoch, stop);
  measure(epoch.stamp, epoch.available, epoch.received, started, runtime::monotonic_now(),
          "busy with the epoch before", clock);
}

// What says nothing is passed over, so that the ring is never full.
void PppStage::hold_feedback() {
  if (feedback_ == nullptr) return;
  while (const MapFeedback* f = feedback_->front()) {
    if (says_something(*f) || f->off_ground) held_.push_back(*f);
    feedback_->pop();
  }
}

void PppStage::hold_motion() {
  if (motion_ == nullptr) return;
  while (const FusedState* state = motion_->front()) {
    track_.add(*state);
    motion_->pop();
  }
}

// Up to which moment everything that comes back from other stages is here.
Time PppStage::known() const {
  Time known = Time::max();
  if (feedback_ != nullptr) known = std::min(known, feedback_->promised());
  if (motion_ != nullptr) known = std::min(known, motion_->promised());
  return known;
}

// On the road alone: whatever has come by now.
void PppStage::take_corrections() {
  if (corrections_ == nullptr) return;
  while (const GnssCorrections* c = corrections_->front()) {
    if (received_) {
      received_->add(c->heard);
      for (const ppp::SsrUpdate& u : c->updates) received_->add(u);
      if (c->ionosphere) received_->add(*c->ionosphere);
    }
    corrections_->pop();
  }
}

// Records how many satellites of this epoch are corrected, and how old the corrections are.
void PppStage::say_corrections() {
  if (corrections_ == nullptr || !received_) return;
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
  correction_age_.store(state_.correction_age.value_or(-1.0), relaxed);
  const std::string what = wrong_with_corrections();
  if (what.empty()) return;
  for (PppState* state : {&state_, &free_state_})
    state->message += (state->message.empty() ? "" : "; ") + what;
}

std::string PppStage::wrong_with_corrections() const {
  const double age = correction_age_.load(relaxed);
  if (corrections_ == nullptr) return {};
  if (age < 0.0) return "ppp: no corrections have come: broadcast orbits and clocks";
  if (age <= to_seconds(ppp::CorrectedEphemeris::longest_age)) return {};
  return "ppp: corrections are " + std::to_string(std::lround(age)) +
         " s old: broadcast orbits and clocks";
}

void PppStage::look_at_ionosphere(ppp::GpsTime t) {
  if (!setup_->one_frequency()) return;
  const auto age = setup_->age_of_ionosphere(t, received_ ? &*received_ : nullptr);
  age_of_ionosphere_.store(age.value_or(Duration::max()), relaxed);
}

std::string PppStage::degraded() const {
  const Duration age = age_of_ionosphere_.load(relaxed);
  const std::string ionosphere =
      ppp::ionosphere_lack(age == Duration::max() ? std::nullopt : std::optional(age));
  std::string what = wrong_with_corrections();
  if (!ionosphere.empty()) what += (what.empty() ? "ppp: " : "; ") + ionosphere;
  return what;
}

// There are no more epochs; neither matcher nor fusion must wait for a full ring.
void PppStage::drain_inputs(const std::stop_token& stop) {
  promise(Time::max());
  while (!stop.stop_requested()) {
    const std::uint32_t heard = bell().listen();
    const Time known = this->known();
    hold_feedback();
    held_.clear();
    hold_motion();
    if (known == Time::max()) return;
    bell().wait(heard);
  }
}

// About the last epoch; what is of the next one is kept for it. The filter knows the receiver's
// time alone, which on the road is not the host's.
void PppStage::use_feedback(Time until) {
  const Duration reach = from_seconds(filter_.parameters().map_reach);
  std::erase_if(held_, [&](MapFeedback& f) {
    if (f.available > until || f.stamp > last_epoch_ + reach) return false;
    f.stamp += receiver_ahead_;
    filter_.note_road(f);
    if (says_something(f)) filter_.add(f);
    return true;
  });
}

void PppStage::process(const GnssEpoch& epoch, const std::stop_token& stop) {
  runtime::TraceSpan span(trace(), "ppp");
  span.step_flow(flow_of(epoch));
  delay(epoch.available);
  if (last_epoch_ != Time::min()) use_feedback(epoch.available);
  if (recalled_) forget_outdated(epoch.epoch.time);
  if (received_) {
    received_->add(epoch.heard);
    received_->begin(epoch.epoch.time);
  }
  const std::optional<ppp::CarriedMotion> motion = track_.motion_to(epoch.stamp, epoch.available);
  ppp::describe(filter_.process(epoch.epoch, motion ? &*motion : nullptr), integrity_risk_, state_);
  ppp::describe_map(filter_, state_);
  ppp::describe(filter_.map_free(), integrity_risk_, free_state_);
  last_epoch_ = epoch.stamp;
  receiver_ahead_ = ppp::to_utc(epoch.epoch.time) - epoch.stamp;
  for (PppState* state : {&state_, &free_state_}) {
    state->stamp = epoch.stamp;
    state->available = epoch.available + spec().budget;
    state->sequence = epoch.sequence;
  }
  say_corrections();
  look_at_ionosphere(epoch.epoch.time);
  counts_.note(state_);
  if (setup_->heights() != nullptr) counts_.heights.add(filter_.map_free().height_use);
  counts_.forgotten_roads.store(filter_.restorations(), relaxed);
  use_.note(epoch.available, state_.status == PppStatus::none ? "no position" : nullptr);
  while (!sent_.empty() && sent_.front().state.available <= epoch.available) {
    spare_ = std::move(sent_.front());
    sent_.erase(sent_.begin());
  }
  spare_.state = state_;
  spare_.has_fix = free_state_.status != PppStatus::none;
  spare_.fix = ppp::to_fix(free_state_);
  sent_.push_back(std::move(spare_));
  sent_.back().fix.increment = ppp::increment_of(filter_.map_free());
  send(sent_.back(), stop);
  use_feedback(epoch.available);
}

void PppStage::send(Sent& sent, const std::stop_token& stop) {
  sent.state.received = sent.fix.received = runtime::monotonic_now();
  states_.push(sent.state, stop);
  if (sent.has_fix) fixes_.push(sent.fix, stop);
  promise(sent.state.available);
}

void PppStage::save_until(Time t, const std::stop_token& stop) {
  const auto promise_until = [this](Time cut) { promise(cut); };
  cuts().save_until(t, stop, promise_until, [this](ArchiveWriter& ar, Time cut) {
    std::erase_if(sent_, [cut](const Sent& s) { return s.state.available <= cut; });
    archive(ar, cut);
  });
}

// Saves and loads what the next run can use, too.
template <class Archive>
void PppStage::archive_known(Archive& ar) {
  ar.section(spec().name, 7);
  bool receives = received_.has_value();
  ar(receives);
  if constexpr (Archive::loading) {
    if (receives != received_.has_value()) ar.fail("other products than this run has");
  }
  ar(filter_);
  if (received_) ar(*received_);
}

// Includes the results that become available after the cut: the run that resumes sends them. The
// matcher that resumes sends the feedback that becomes available after the cut.
template <class Archive>
void PppStage::archive(Archive& ar, Time cut) {
  archive_known(ar);
  std::vector<MapFeedback> held;
  std::copy_if(held_.begin(), held_.end(), std::back_inserter(held),
               [cut](const MapFeedback& f) { return f.available <= cut; });
  ar(counts_, sent_, held, last_epoch_);
  track_.archive(ar, cut);
  if constexpr (Archive::loading) held_ = std::move(held);
}

void PppStage::recall_saved(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  archive_known(ar);
  filter_.count_anew();
  recalled_ = true;
}

Bytes PppStage::kept() {
  ArchiveWriter ar;
  archive_known(ar);
  return ar.take();
}

void PppStage::forget_outdated(ppp::GpsTime now) {
  recalled_ = false;
  if (now > filter_.last_epoch() && now - filter_.last_epoch() < longest_away) return;
  filter_ = setup_->make_map_aided_filter(received_ ? &*received_ : nullptr);
  counts_.outdated.fetch_add(1, relaxed);
}

std::size_t PppStage::saved_bytes() const {
  return ppp::MapAidedFilter::largest_archive + AntennaTrack::largest_archive +
         (received_ ? ppp::CorrectedEphemeris::usual_archive : 0) +
         2 * ppp::usual_satellites * sizeof(PppSatellite) + 4096;
}

}  // namespace maploop::vehicle
