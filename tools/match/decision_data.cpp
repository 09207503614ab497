#include "tools/match/decision_data.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "mapmatch/reasons.h"
#include "tools/match/road_lines.h"

namespace maploop::match {
namespace {

using mapmatch::MatchResult;
using nlohmann::json;

constexpr double surroundings = 250.0;       // m around the track, of which roads are drawn
constexpr std::size_t shown_candidates = 8;  // for each fix

// Returns the value rounded to a fraction of one; null if it is not finite.
json rounded(double value, double fractions) {
  return std::isfinite(value) ? json(std::round(value * fractions) / fractions) : json();
}

// Numbers things in the order in which they come, and stores each of them once.
template <class Item>
class Numbered {
 public:
  std::size_t index(const Item& item) {
    const auto [found, added] = indices_.emplace(item, items_.size());
    if (added) items_.push_back(item);
    return found->second;
  }
  json indices(const std::vector<Item>& items) {
    json list = json::array();
    for (const Item& item : items) list.push_back(index(item));
    return list;
  }
  const std::vector<Item>& all() const { return items_; }

 private:
  std::map<Item, std::size_t> indices_;
  std::vector<Item> items_;
};

json road_of(const mapmatch::RoadNetwork& network, std::uint32_t link) {
  json x = json::array(), y = json::array();
  for (const mapmatch::Vertex& v : network.shape(link)) {
    x.push_back(rounded(v.east, 10.0));
    y.push_back(rounded(v.north, 10.0));
  }
  const mapmatch::Road& road = network.road_at(network.link(link).first_vertex);
  const bool both = network.link(link).forward && network.link(link).backward;
  return {
      {"name", (road.name.empty() ? "" : road.name + ", ") + "way " + std::to_string(road.way_id) +
                   ", " + std::string(to_string(road.road_class)) + (both ? "" : ", one way")},
      {"x", std::move(x)},
      {"y", std::move(y)}};
}

class Decisions {
 public:
  Decisions(const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules)
      : network_(network), rules_(rules) {}

  void add(double second, const mapmatch::VehicleFix& fix, const MatchResult& r) {
    const Eigen::Vector2d place = network_.to_local(fix.position);
    const auto if_matched = [&](double value) { return r.on_road ? value : mapmatch::unknown; };
    places_.push_back(place);
    data_["time"].push_back(rounded(second, 1e3));
    data_["x"].push_back(rounded(place.x(), 100.0));
    data_["y"].push_back(rounded(place.y(), 100.0));
    data_["matched_x"].push_back(rounded(if_matched(r.point.position.x()), 100.0));
    data_["matched_y"].push_back(rounded(if_matched(r.point.position.y()), 100.0));
    data_["p"].push_back(rounded(if_matched(r.probability), 1e4));
    data_["phase"].push_back(texts_.index(std::string(to_string(r.phase))));
    LinkMatch shown = r;
    shown.candidate_count = std::min(r.candidate_count, shown_candidates);
    const MapMatchWords words = in_words(shown, network_, rules_);
    data_["explanation"].push_back(texts_.index(words.explanation));
    json candidates = json::array();
    for (std::size_t i = 0; i < shown.candidate_count; ++i)
      candidates.push_back(candidate(shown.candidates[i], words.candidates[i]));
    data_["candidates"].push_back(std::move(candidates));
  }

  json data() {
    const Eigen::Vector2d* last = nullptr;
    for (const Eigen::Vector2d& place : places_) {
      if (last && (place - *last).norm() < 0.5 * surroundings) continue;
      last = &place;
      network_.index().visit(box_about({place}, surroundings),
                             [&](const auto& segment) { links_.index(segment.link); });
    }
    data_["roads"] = json::array();
    for (const std::uint32_t link : links_.all()) data_["roads"].push_back(road_of(network_, link));
    data_["texts"] = texts_.all();
    return std::move(data_);
  }

 private:
  // The order is that of match.ts.
  json candidate(const mapmatch::MatchCandidate& c, const MapMatchWords::Candidate& words) {
    const Eigen::Vector2d place = network_.at(c.link, c.along).position;
    return {links_.index(c.link.link),        rounded(place.x(), 10.0),   rounded(place.y(), 10.0),
            rounded(c.probability, 1e4),      rounded(c.likelihood, 1.0), texts_.index(words.road),
            texts_.indices(words.objections), texts_.indices(words.rules)};
  }

  const mapmatch::RoadNetwork& network_;
  const mapmatch::RuleBases& rules_;
  std::vector<Eigen::Vector2d> places_;
  Numbered<std::string> texts_;
  Numbered<std::uint32_t> links_;
  json data_ = json::object();
};

}  // namespace

json decision_data(const MatchedTrack& track, const mapmatch::RoadNetwork& network,
                   const mapmatch::RuleBases& rules) {
  Decisions decisions(network, rules);
  for (const std::size_t i : track.used())
    decisions.add(track.second(i), track.fixes[i], track.results[i]);
  return decisions.data();
}

}  // namespace maploop::match
