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
                             const mapmatch::MatchParameters& parameters, MapMatchEdges& inputs,
                             std::vector<runtime::Edge<MapMatch>*> matches)
    : map_(std::move(map)),
      matcher_(map_->network, map_->rules, parameters),
      inputs_(inputs),
      matches_(std::move(matches)),
      meter_(stages::mapmatch) {
  intake_.add(inputs_.nav_state, [this](const NavState& state) { newest_ = state; });
  intake_.add(inputs_.visual, [this](const RelativeMotion& motion) { matcher_.add(motion); });
}

void MapMatchStage::run(const runtime::DataClock& clock, Time first, const std::stop_token& stop) {
  // Whatever the graph declares for a live run: the same bits need every tick.
  const runtime::Schedule schedule{stages::mapmatch.period, stages::mapmatch.phase,
                                   runtime::Overrun::catch_up};
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
  if (intake_.promised() < k) {
    const runtime::TraceSpan waiting(trace_, "waiting for input");
    if (!intake_.wait(k, inputs_.bell, stop)) return false;
    ready = runtime::monotonic_now();
  }
  save_until(k - Duration(1), stop);
  if (intake_.finished()) return false;

  delay_(k);
  intake_.take_until(k);
  MapMatch& match = matcher_.add(newest_);
  match.available = k + stages::mapmatch.budget;
  match.sequence = ticks_++;
  counts_[static_cast<std::size_t>(match.refusal)].fetch_add(1, std::memory_order_relaxed);
  for (auto* edge : matches_) edge->push(match, stop);

  const MonotonicTime done = runtime::monotonic_now();
  meter_.ran(done - ready);
  if (clock.keeps_time(k)) {
    meter_.woke(tick, clock, due, woken);
    const bool missed = meter_.latency().record({k,
                                                 done - due,
                                                 {{{"woken late", woken - due},
                                                   {"waiting for input", ready - woken},
                                                   {"running", done - ready}}}});
    if (missed) runtime::trace_instant(trace_, "missed deadline");
  } else {
    meter_.latency().record(done - ready);
  }
  promise(k + stages::mapmatch.period + stages::mapmatch.budget - Duration(1));
  return true;
}

// At the tick after a cut: by then every input up to the cut is here.
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
  ar(stage.matcher_, stage.newest_, stage.ticks_, counts);
  if constexpr (Archive::loading) std::copy(counts.begin(), counts.end(), stage.counts_.begin());
}

void MapMatchStage::resume(std::span<const std::uint8_t> saved) {
  ArchiveReader ar(saved);
  describe(ar, *this);
  ar.finish();
}

void MapMatchStage::promise(Time t) {
  for (auto* edge : matches_) edge->promise(t);
}

void MapMatchStage::finish() {
  promise(Time::max());
  cuts_.finish();
}

}  // namespace maploop::vehicle
