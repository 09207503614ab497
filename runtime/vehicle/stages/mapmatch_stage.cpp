#include "runtime/vehicle/stages/mapmatch_stage.h"

#include <utility>

namespace maploop::vehicle {
namespace {

// A snapshot is cut at a tick of the fusion: none of a match's inputs is then taken and its result
// still on its way.
static_assert(stages::mapmatch.phase == stages::fusion.budget &&
              stages::mapmatch.period % stages::fusion.period == Duration::zero() &&
              stages::mapmatch.phase + stages::mapmatch.budget < stages::fusion.period);

}  // namespace

MapMatchStage::MapMatchStage(Rings& rings, std::shared_ptr<const RoadMap> map,
                             const mapmatch::MatchParameters& parameters,
                             const std::optional<mapmatch::FeedbackParameters>& feedback)
    : GraphStage(stages::mapmatch, rings),
      map_(std::move(map)),
      matcher_(map_->network, map_->rules, parameters),
      doubts_(map_->network, parameters),
      matches_(outputs(rings::mapmatch_publisher)),
      doubts_out_(outputs(rings::doubt_publisher)),
      feedbacks_(outputs(rings::mapmatch_fusion, rings::feedback_publisher, rings::mapmatch_ppp)) {
  if (feedback) feedback_.emplace(map_->network, *feedback);
  GraphStage::take(intake_, rings::fusion_mapmatch,
                   [this](const NavState& state) { newest_ = state; });
  for (const auto* visual : {&rings::stereo_mapmatch, &rings::visual_log_mapmatch}) {
    GraphStage::take(intake_, *visual,
                     [this](const RelativeMotion& motion) { matcher_.add(motion); });
  }
}

void MapMatchStage::run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) {
  const runtime::Schedule schedule = this->schedule(clock);
  promise(runtime::first_tick(begin, schedule.period, schedule.phase) + spec().budget -
          Duration(1));
  runtime::run_periodic(clock, begin, schedule, stop,
                        [&](const runtime::Tick& t) { return tick(t, clock, stop); });
}

bool MapMatchStage::tick(const runtime::Tick& tick, const runtime::DataClock& clock,
                         const std::stop_token& stop) {
  const Time k = tick.time;
  const runtime::TraceSpan span(trace(), "tick");
  const MonotonicTime due = clock.due(k);
  const MonotonicTime woken = runtime::monotonic_now();
  MonotonicTime ready = woken;
  const std::uint64_t taken_before = intake_.taken();
  if (intake_.promised() < k) {
    const runtime::TraceSpan waiting(trace(), "waiting for input");
    if (!wait_until(k, stop)) return false;
    ready = runtime::monotonic_now();
  }
  save_until(k - Duration(1), stop);
  if (intake_.finished() && intake_.taken() == taken_before) {
    publish(doubts_.finish(), k + spec().budget, stop);
    return false;
  }

  delay(k);
  intake_.take_until(k);
  MapMatch& match = matcher_.add(newest_);
  match.available = k + spec().budget;
  match.sequence = ticks_++;
  counts_.add(match.refusal);
  matches_.push(match, stop);
  const mapmatch::VehicleFix fix = mapmatch::fix_of(newest_);
  publish(doubts_.add(match, fix), match.available, stop);
  if (feedback_) {
    MapFeedback feedback = feedback_->decide(match, fix);
    feedback.available = match.available;
    feedbacks_.push(feedback, stop);
  }

  measure(tick, {due, woken, ready, runtime::monotonic_now()}, intake_.waiting(), clock);
  promise(k + spec().period + spec().budget - Duration(1));
  return true;
}

// Publishes the doubts that are likelier than not.
void MapMatchStage::publish(std::span<const MapDoubt> found, Time available,
                            const std::stop_token& stop) {
  for (MapDoubt doubt : found) {
    if (!(doubt.probability > 0.5)) continue;
    doubt.available = available;
    doubt.sequence = doubt_count_++;
    doubts_out_.push(doubt, stop);
  }
}

// Nothing after a cut is taken before it is saved.
bool MapMatchStage::wait_until(Time t, const std::stop_token& stop) {
  for (Time cut = cuts().next(); cut < t; cut = cuts().next()) {
    if (!intake_.wait(cut, bell(), stop)) return false;
    save_until(cut, stop);
  }
  return intake_.wait(t, bell(), stop);
}

// When every input up to the cut is here.
void MapMatchStage::save_until(Time t, const std::stop_token& stop) {
  cuts().save_until(t, stop, [this](ArchiveWriter& ar, Time cut) {
    intake_.take_until(cut);
    archive(ar);
  });
}

template <class Archive>
void MapMatchStage::archive(Archive& ar) {
  ar.section(spec().name, 3);
  bool closed = feedback_.has_value();
  ar(matcher_, doubts_, newest_, ticks_, doubt_count_, counts_, closed);
  if constexpr (Archive::loading) {
    if (closed != feedback_.has_value()) {
      ar.fail(closed ? "it was saved with feedback of the map, which is off here"
                     : "it was saved without feedback of the map, which is on here");
    }
  }
  if (feedback_) ar(*feedback_);
}

}  // namespace maploop::vehicle
