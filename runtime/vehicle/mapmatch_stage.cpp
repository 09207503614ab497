#include "runtime/vehicle/mapmatch_stage.h"

#include <algorithm>

#include "runtime/vehicle/graph.h"

namespace maploop::vehicle {
namespace {

// A snapshot is cut at a tick of the fusion: none of a match's inputs is then taken and its result
// still on its way.
static_assert(stages::mapmatch.phase == stages::fusion.budget &&
              stages::mapmatch.period % stages::fusion.period == Duration::zero() &&
              stages::mapmatch.phase + stages::mapmatch.budget < stages::fusion.period);

}  // namespace

MapMatchEdges::MapMatchEdges()
    : nav_state(make_edge<NavState>(edges::fusion_mapmatch, &bell)),
      visual(make_edge<RelativeMotion>(edges::stereo_mapmatch, &bell)) {}

MapMatchStage::MapMatchStage(std::shared_ptr<const RoadMap> map,
                             const mapmatch::MatchParameters& parameters,
                             const std::optional<mapmatch::FeedbackParameters>& feedback,
                             MapMatchEdges& inputs, std::vector<runtime::Edge<MapMatch>*> matches,
                             std::vector<runtime::Edge<MapFeedback>*> feedbacks)
    : map_(std::move(map)),
      matcher_(map_->network, map_->rules, parameters),
      inputs_(inputs),
      matches_(std::move(matches)),
      feedbacks_(std::move(feedbacks)),
      meter_(stages::mapmatch) {
  if (feedback) feedback_.emplace(map_->network, *feedback);
  intake_.add(inputs_.nav_state, [this](const NavState& state) { newest_ = state; });
  intake_.add(inputs_.visual, [this](const RelativeMotion& motion) { matcher_.add(motion); });
}

void MapMatchStage::run(const runtime::DataClock& clock, Time first, const std::stop_token& stop) {
  // What the graph declares is of a live run: the same bits need every tick.
  const runtime::Schedule schedule{
      stages::mapmatch.period, stages::mapmatch.phase,
      clock.is_live() ? stages::mapmatch.overrun : runtime::Overrun::catch_up};
  promise(runtime::first_tick(first, schedule.period, schedule.phase) + stages::mapmatch.budget -
          Duration(1));
  runtime::run_periodic(clock, first, schedule, stop,
                        [&](const runtime::Tick& t) { return tick(t, clock, stop); });
}

bool MapMatchStage::tick(const runtime::Tick& tick, const runtime::DataClock& clock,
                         const std::stop_token& stop) {
  const Time k = tick.time;
  const runtime::TraceSpan span(trace_, "tick");
  const MonotonicTime due = clock.due(k);
  const MonotonicTime woken = runtime::monotonic_now();
  MonotonicTime ready = woken;
  const std::uint64_t taken_before = intake_.taken();
  if (intake_.promised() < k) {
    const runtime::TraceSpan waiting(trace_, "waiting for input");
    if (!wait_until(k, stop)) return false;
    ready = runtime::monotonic_now();
  }
  save_until(k - Duration(1), stop);
  if (intake_.finished() && intake_.taken() == taken_before) return false;

  delay_(k);
  intake_.take_until(k);
  MapMatch& match = matcher_.add(newest_);
  match.available = k + stages::mapmatch.budget;
  match.sequence = ticks_++;
  counts_[static_cast<std::size_t>(match.refusal)].fetch_add(1, std::memory_order_relaxed);
  for (auto* edge : matches_) edge->push(match, stop);
  if (feedback_) {
    MapFeedback feedback = feedback_->decide(match, mapmatch::fix_of(newest_));
    feedback.available = match.available;
    for (auto* edge : feedbacks_) edge->push(feedback, stop);
  }

  const MonotonicTime done = runtime::monotonic_now();
  meter_.ran(done - ready);
  if (clock.keeps_time(k)) {
    meter_.woke(tick, clock, due, woken);
    const bool missed = meter_.latency().record({k,
                                                 done - due,
                                                 {{{"woken late", woken - due},
                                                   {intake_.waiting(), ready - woken},
                                                   {"running", done - ready}}}});
    if (missed) runtime::trace_instant(trace_, "missed deadline");
  } else {
    meter_.latency().record(done - ready);
  }
  promise(k + stages::mapmatch.period + stages::mapmatch.budget - Duration(1));
  return true;
}

// Nothing after a cut is taken before it is saved.
bool MapMatchStage::wait_until(Time t, const std::stop_token& stop) {
  for (Time cut = cuts_.next(); cut < t; cut = cuts_.next()) {
    if (!intake_.wait(cut, inputs_.bell, stop)) return false;
    save_until(cut, stop);
  }
  return intake_.wait(t, inputs_.bell, stop);
}

// When every input up to the cut is here.
void MapMatchStage::save_until(Time t, const std::stop_token& stop) {
  cuts_.save_until(t, stop, [this](ArchiveWriter& ar, Time cut) {
    intake_.take_until(cut);
    describe(ar, *this);
  });
}

template <class Archive, class Stage>
void MapMatchStage::describe(Archive& ar, Stage& stage) {
  ar.section(stages::mapmatch.name, 2);
  std::array<std::uint64_t, fix_refusal_count> counts{};
  std::copy(stage.counts_.begin(), stage.counts_.end(), counts.begin());
  bool closed = stage.feedback_.has_value();
  ar(stage.matcher_, stage.newest_, stage.ticks_, counts, closed);
  if constexpr (Archive::loading) {
    if (closed != stage.feedback_.has_value())
      ar.fail("the other one feeds the map back, or does not");
  }
  if (stage.feedback_) ar(*stage.feedback_);
  if constexpr (Archive::loading) std::copy(counts.begin(), counts.end(), stage.counts_.begin());
}

void MapMatchStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this);
  ar.finish();
}

void MapMatchStage::promise(Time t) {
  for (auto* edge : feedbacks_) edge->promise(t);
  for (auto* edge : matches_) edge->promise(t);
}

void MapMatchStage::finish() {
  promise(Time::max());
  cuts_.finish();
  intake_.abandon();
}

}  // namespace maploop::vehicle
