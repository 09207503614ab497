#include "runtime/vehicle/stages/mapmatch_stage.h"

#include <algorithm>
#include <utility>

namespace maploop::vehicle {
namespace {

// A snapshot is cut at a tick of the fusion: none of a match's inputs is then taken and its result
// still on its way.
static_assert(stages::mapmatch.phase == stages::fusion.budget &&
              stages::mapmatch.period % stages::fusion.period == Duration::zero() &&
              stages::mapmatch.phase + stages::mapmatch.budget < stages::fusion.period);

// Longer than a match may wait for the publisher, which describes it with its own roads.
constexpr int between_changes = 80;
static_assert(between_changes > rings::mapmatch_publisher.capacity);
constexpr std::size_t remembered = 100;  // states with which matching in a new window begins

}  // namespace

MapMatchStage::Matching::Matching(std::shared_ptr<const mapmatch::RoadNetwork> roads,
                                  const mapmatch::RuleBases& rules,
                                  const mapmatch::MatchParameters& parameters,
                                  const std::optional<mapmatch::FeedbackParameters>& back)
    : network(std::move(roads)),
      matcher(*network, rules, parameters),
      doubts(*network, parameters) {
  if (back) feedback.emplace(*network, *back);
}

MapMatchStage::MapMatchStage(Rings& rings, std::shared_ptr<const RoadMap> map,
                             std::shared_ptr<NetworksInUse> networks,
                             const mapmatch::MatchParameters& parameters,
                             const std::optional<mapmatch::FeedbackParameters>& feedback)
    : GraphStage(stages::mapmatch, rings),
      map_(std::move(map)),
      parameters_(parameters),
      feedback_parameters_(feedback),
      window_(map_),
      networks_(std::move(networks)),
      matches_(outputs(rings::mapmatch_publisher)),
      doubts_out_(outputs(rings::doubt_publisher)),
      feedbacks_(outputs(rings::mapmatch_fusion, rings::feedback_publisher, rings::mapmatch_ppp)) {
  if (window_.moves()) recent_.reserve(remembered);
  begin_matching();
  GraphStage::take(intake_, rings::fusion_mapmatch,
                   [this](const NavState& state) { newest_ = state; });
  for (const auto* visual : {&rings::stereo_mapmatch, &rings::visual_log_mapmatch}) {
    GraphStage::take(intake_, *visual,
                     [this](const RelativeMotion& motion) { matching_->matcher.add(motion); });
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
    publish(matching_->doubts.finish(), k + spec().budget, stop);
    return false;
  }

  delay(k);
  intake_.take_until(k);
  const mapmatch::VehicleFix fix = mapmatch::fix_of(newest_);
  if (window_.moves() && mapmatch::has_position(newest_)) {
    if (since_change_ >= between_changes && window_.follow(fix.position)) {
      publish(matching_->doubts.finish(), k + spec().budget, stop);
      begin_matching();
      since_change_ = 0;
    }
    since_change_ = std::min(since_change_ + 1, between_changes);
    remember(newest_);
  }
  MapMatch& match = matching_->matcher.add(newest_);
  match.available = k + spec().budget;
  match.sequence = ticks_++;
  counts_.add(match.refusal);
  matches_.push(match, stop);
  publish(matching_->doubts.add(match, fix), match.available, stop);
  if (matching_->feedback) {
    MapFeedback feedback = matching_->feedback->decide(match, fix);
    feedback.available = match.available;
    feedbacks_.push(feedback, stop);
  }

  measure(tick, {due, woken, ready, runtime::monotonic_now()}, intake_.waiting(), clock);
  promise(k + spec().period + spec().budget - Duration(1));
  return true;
}

void MapMatchStage::remember(const NavState& state) {
  if (recent_.size() == remembered) recent_.erase(recent_.begin());
  recent_.push_back(state);
}

// Matches the last states again on the roads of the window; they were reported before, and so were
// their doubts.
void MapMatchStage::begin_matching() {
  auto next =
      std::make_unique<Matching>(window_.network(), map_->rules, parameters_, feedback_parameters_);
  networks_->begin(recent_.empty() ? Time::min() : recent_.back().stamp, window_.network());
  for (const NavState& state : recent_) {
    const MapMatch& match = next->matcher.add(state);
    if (next->feedback) next->feedback->decide(match, mapmatch::fix_of(state));
  }
  if (matching_) next->matcher.take_course(matching_->matcher);
  matching_ = std::move(next);
}

std::vector<RefusalCount> MapMatchStage::refusals() {
  std::vector<RefusalCount> list = counts_.of(spec().name);
  if (const MapWindow::Failures failures = window_.failures(); failures.count > 0)
    list.push_back({std::string(spec().name), failures.last, failures.count});
  return list;
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
  ar.section(spec().name, 5);
  bool closed = feedback_parameters_.has_value();
  ar(window_, recent_, since_change_);
  if constexpr (Archive::loading) {
    recent_.reserve(window_.moves() ? remembered : 0);
    begin_matching();
  }
  ar(matching_->matcher, matching_->doubts, newest_, ticks_, doubt_count_, counts_, closed);
  if constexpr (Archive::loading) {
    if (closed != feedback_parameters_.has_value()) {
      ar.fail(closed ? "it was saved with feedback of the map, which is off here"
                     : "it was saved without feedback of the map, which is on here");
    }
  }
  if (matching_->feedback) ar(*matching_->feedback);
}

}  // namespace maploop::vehicle
