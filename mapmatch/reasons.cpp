#include "mapmatch/reasons.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double notable_azimuth = radians(20.0);
constexpr double notable_distance = 8.0;         // m
constexpr double notable_distance_error = 10.0;  // m
constexpr float notable_weight = 0.1f;

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f", value);
  return text.data();
}

const FuzzySystem& system_of(RuleBase base, const RuleBases& rules) {
  switch (base) {
    case RuleBase::initial:
      return rules.initial;
    case RuleBase::along:
      return rules.along;
    case RuleBase::along_visual:
      return rules.along_visual;
    case RuleBase::junction:
      break;
  }
  return rules.junction;
}

std::string name_of(const Road& road) {
  const std::string way = "way " + std::to_string(road.way_id);
  return road.name.empty() ? way : road.name + " (" + way + ")";
}

std::string name_of(const RoadNetwork& network, DirectedLink link, double along) {
  return name_of(network.road_at(network.at(link, along).vertex));
}

// Returns the name of the road at a segment of a doubt.
std::string name_of(const RoadNetwork& network, const MapDoubt::Segment& segment) {
  if (segment.way_id == 0) return "no road";
  for (const Vertex& v : network.shape(segment.link.link)) {
    const Road& road = network.data().roads[v.road];
    if (road.way_id == segment.way_id) return name_of(road);
  }
  return "way " + std::to_string(segment.way_id);
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ", ") + w;
  return text;
}

}  // namespace

std::vector<std::string> objections(const MatchCandidate& c, const RoadNetwork& network) {
  std::vector<std::string> found;
  if (c.azimuth_error > notable_azimuth)
    found.push_back("azimuth differs by " + rounded(degrees(c.azimuth_error)) + " degrees");
  if (c.distance > notable_distance) found.push_back(rounded(c.distance) + " m away");
  if (!network.allowed(c.link)) found.emplace_back("against its one-way direction");
  if (c.rules == RuleBase::junction) {
    if (c.connectivity < 0.2) {
      found.emplace_back("not connected with the link before");
    } else if (c.connectivity < 0.8) {
      found.emplace_back("no legal turn leads there");
    }
    if (c.connectivity >= 0.2 && c.distance_error > notable_distance_error) {
      found.push_back("the way there differs by " + rounded(c.distance_error) +
                      " m from the distance travelled");
    }
  }
  return found;
}

std::vector<std::pair<std::string, double>> fired_rules(const MatchCandidate& c,
                                                        const RuleBases& rules) {
  const FuzzySystem& system = system_of(c.rules, rules);
  std::vector<std::pair<std::string, double>> fired;
  for (std::size_t i = 0; i < system.rules().size(); ++i) {
    if (c.weights[i] > notable_weight)
      fired.emplace_back(system.rules()[i].text, static_cast<double>(c.weights[i]));
  }
  std::stable_sort(fired.begin(), fired.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return fired;
}

std::string explanation(const LinkMatch& r, const RoadNetwork& network) {
  if (r.refusal != FixRefusal::none) return "not used: " + std::string(to_string(r.refusal));
  if (!r.on_road) {
    if (r.candidate_count == 0) return "no road near";
    const auto against = objections(r.candidates[0], network);
    const std::string nearest = name_of(network, r.candidates[0].link, r.candidates[0].along);
    return against.empty() ? "no road has fitted for some time; nearest in all: " + nearest
                           : "no road fits; " + nearest + ": " + list(against);
  }
  std::string text =
      name_of(network, r.link, r.along) + ", P " + rounded(100.0 * r.probability) + " %";
  for (std::size_t i = 0; i < r.candidate_count; ++i) {
    const MatchCandidate& other = r.candidates[i];
    if (other.link == r.link) continue;
    const auto against = objections(other, network);
    text += "; not " + name_of(network, other.link, other.along) + ": " +
            (against.empty() ? "less likely by the way so far" : list(against));
    break;
  }
  return text;
}

std::string explanation(const MapDoubt& doubt, const RoadNetwork& network) {
  const std::string from = name_of(network, doubt.from), to = name_of(network, doubt.to);
  const std::string length = rounded(doubt.length) + " m";
  switch (doubt.kind) {
    case DoubtKind::missing_road:
      return length + " were driven where the map has no road, from " + from + " to " + to;
    case DoubtKind::wrong_direction:
      return from + " was driven against its one-way direction for " + length;
    case DoubtKind::forbidden_turn:
      return "the turn from " + from + " into " + to + ", which the map forbids, was driven";
    case DoubtKind::shifted_road:
      break;
  }
  return from + " was driven " + rounded(std::abs(doubt.offset)) + " m to the " +
         (doubt.offset > 0.0 ? "right" : "left") + " of its line for " + length;
}

MapMatchWords in_words(const LinkMatch& match, const RoadNetwork& network, const RuleBases& rules) {
  MapMatchWords words;
  words.explanation = explanation(match, network);
  for (std::size_t i = 0; i < match.candidate_count; ++i) {
    const MatchCandidate& c = match.candidates[i];
    MapMatchWords::Candidate said{name_of(network, c.link, c.along), objections(c, network), {}};
    for (const auto& [text, weight] : fired_rules(c, rules)) {
      std::array<char, 16> number{};
      std::snprintf(number.data(), number.size(), "%.2f: ", weight);
      said.rules.push_back(number.data() + text);
    }
    words.candidates.push_back(std::move(said));
  }
  return words;
}

}  // namespace maploop::mapmatch
