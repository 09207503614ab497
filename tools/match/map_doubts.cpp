#include "tools/match/map_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mapmatch/feedback_parameters.h"
#include "mapmatch/match_parameters.h"
#include "mapmatch/reasons.h"
#include "tools/match/driven_streets.h"
#include "tools/web/events.h"

namespace maploop::match {
namespace {

using mapmatch::FixRefusal;
using mapmatch::MatchCandidate;
using mapmatch::MatchResult;
using web::Event;
using Events = std::vector<Event>;

constexpr double legal = 0.8;  // connectivity, below which no legal turn leads to a candidate

// A track whose fixes and results are visited with their time.
class Doubts {
 public:
  Doubts(const MatchedTrack& track, const mapmatch::RoadNetwork& network)
      : track_(track), network_(network) {
    const auto steps = static_cast<double>(std::max<std::size_t>(track.fixes.size(), 2) - 1);
    if (!track.fixes.empty())
      gap_ = std::max(gap_, 1.5 * track.second(track.fixes.size() - 1) / steps);
  }

  Events off_road() const {
    Events events;
    visit([&](double second, const MatchResult& r, const mapmatch::VehicleFix&) {
      if (r.on_road) return;
      Event& event = web::extend(events, second, gap_, {0, 0, Event::Level::warning, {}});
      if (event.text.empty()) event.text = "on no road of the map: " + explanation(r, network_);
    });
    return events;
  }

  Events forbidden() const {
    Events events;
    DirectedLink last;  // of the event
    visit([&](double second, const MatchResult& r, const mapmatch::VehicleFix&) {
      const MatchCandidate* matched = matched_candidate(r);
      if (!matched || !is_forbidden(*matched)) return;
      const bool same = !events.empty() && r.link == last;
      Event& event =
          web::extend(events, second, same ? gap_ : -1.0, {0, 0, Event::Level::warning, {}});
      if (event.text.empty()) event.text = said_against(*matched, r);
      last = r.link;
    });
    return events;
  }

  Events fallen() const {
    Events events;
    double least = 1.0;  // P(link) of the event
    const double map_sigma = mapmatch::MatchParameters{}.map_sigma;
    const double trusted = mapmatch::FeedbackParameters{}.min_probability;
    visit([&](double second, const MatchResult& r, const mapmatch::VehicleFix& fix) {
      const double sigma = std::sqrt(0.5 * fix.covariance.trace());
      if (!r.on_road || r.phase == mapmatch::MatchPhase::initial || !(sigma < map_sigma) ||
          !(street_probability(r) < trusted))
        return;
      const std::size_t count = events.size();
      Event& event = web::extend(events, second, gap_, {0, 0, Event::Level::note, {}});
      if (events.size() == count && r.probability >= least) return;
      least = r.probability;
      event.text = fmt::format("P fell although the position is good to {:.1f} m: {}", sigma,
                               explanation(r, network_));
    });
    return events;
  }

  Events refused() const {
    Events events;
    FixRefusal last = FixRefusal::none;
    double now = 0.0;  // a time that went back is not on the timeline
    for (std::size_t i = 0; i < track_.fixes.size(); ++i) {
      const FixRefusal refusal = track_.results[i].refusal;
      now = std::max(now, track_.second(i));
      if (refusal == FixRefusal::none) continue;
      web::extend(events, now, refusal == last ? gap_ : -1.0, {0, 0, Event::Level::error, {}})
          .text = "fixes not used: " + std::string(to_string(refusal));
      last = refusal;
    }
    return events;
  }

 private:
  // Calls for each fix that was used.
  void visit(const auto& act) const {
    for (const std::size_t i : track_.used())
      act(track_.second(i), track_.results[i], track_.fixes[i]);
  }

  static const MatchCandidate* matched_candidate(const MatchResult& r) {
    const auto end = r.candidates.begin() + static_cast<std::ptrdiff_t>(r.candidate_count);
    const auto found = std::find_if(r.candidates.begin(), end,
                                    [&](const MatchCandidate& c) { return c.link == r.link; });
    return r.on_road && found != end ? &*found : nullptr;
  }

  // Returns the probability of all candidates on the matched street: at a junction along it, its
  // links share what is certain of the street.
  double street_probability(const MatchResult& r) const {
    const mapmatch::Road& street = network_.road_at(r.point.vertex);
    double sum = 0.0;
    for (std::size_t i = 0; i < r.candidate_count; ++i) {
      const MatchCandidate& c = r.candidates[i];
      const mapmatch::Road& road = network_.road_at(network_.at(c.link, c.along).vertex);
      const bool same_name = !road.name.empty() && road.name == street.name;
      if (same_name || road.way_id == street.way_id) sum += c.probability;
    }
    return sum;
  }

  bool is_forbidden(const MatchCandidate& c) const {
    return !network_.allowed(c.link) ||
           (c.rules == mapmatch::RuleBase::junction && c.connectivity < legal);
  }

  std::string said_against(const MatchCandidate& c, const MatchResult& r) const {
    std::string text = street_name(network_.road_at(r.point.vertex));
    for (const std::string& objection : objections(c, network_)) text += ", " + objection;
    return text;
  }

  const MatchedTrack& track_;
  const mapmatch::RoadNetwork& network_;
  double gap_ = 2.0;  // s between two moments of one event
};

}  // namespace

std::vector<Event> map_doubts(const MatchedTrack& track, const mapmatch::RoadNetwork& network) {
  const Doubts doubts(track, network);
  Events all;
  for (const Events& some :
       {doubts.off_road(), doubts.forbidden(), doubts.fallen(), doubts.refused()})
    all.insert(all.end(), some.begin(), some.end());
  web::sort_by_time(all);
  return all;
}

}  // namespace maploop::match
