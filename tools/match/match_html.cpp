#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "mapmatch/reasons.h"
#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/match_output.h"
#include "tools/match/road_lines.h"
#include "tools/web/bundle.h"

namespace maploop::match {
namespace {

using nlohmann::json;

constexpr double surroundings = 250.0;       // m, margin around the track that is drawn
constexpr std::size_t shown_candidates = 8;  // for each fix

// Returns the value rounded to a fraction of one.
double rounded(double value, double fractions) {
  return std::round(value * fractions) / fractions;
}

json point(const Eigen::Vector2d& p) {
  return {rounded(p.x(), 100.0), rounded(p.y(), 100.0)};
}

// Returns the links near the track and all candidates; `used` marks the candidates' links.
json roads_about(const mapmatch::RoadNetwork& network, const mapmatch::Box& box,
                 std::vector<bool> used) {
  network.index().visit(box, [&](const mapmatch::IndexedSegment& s) { used[s.link] = true; });
  json roads = json::object();
  for (std::uint32_t i = 0; i < network.size(); ++i) {
    if (!used[i]) continue;
    json shape = json::array();
    for (const mapmatch::Vertex& v : network.shape(i)) shape.push_back(point(v.position()));
    const mapmatch::Link& link = network.link(i);
    const mapmatch::Road& road = network.road_at(link.first_vertex);
    const char* direction = link.forward && link.backward ? "" : ", one way";
    roads[std::to_string(i)] = {
        {"shape", std::move(shape)},
        {"rank", static_cast<int>(road.road_class)},
        {"name", road.name + (road.name.empty() ? "way " : " (way ") + std::to_string(road.way_id) +
                     ", " + std::string(to_string(road.road_class)) + direction +
                     (road.name.empty() ? "" : ")")}};
  }
  return roads;
}

// Stores each text once.
class Texts {
 public:
  int index(const std::string& text) {
    const auto [found, added] = indices_.emplace(text, static_cast<int>(texts_.size()));
    if (added) texts_.push_back(text);
    return found->second;
  }
  const std::vector<std::string>& all() const { return texts_; }

 private:
  std::map<std::string, int> indices_;
  std::vector<std::string> texts_;
};

json candidates_of(const mapmatch::MatchResult& r, const mapmatch::RoadNetwork& network,
                   const mapmatch::RuleBases& rules, Texts& texts, std::vector<bool>& used) {
  json candidates = json::array();
  for (std::size_t i = 0; i < std::min(r.candidate_count, shown_candidates); ++i) {
    const mapmatch::MatchCandidate& c = r.candidates[i];
    used[c.link.link] = true;
    json fired = json::array();
    for (const auto& [text, weight] : fired_rules(c, rules))
      if (weight >= 0.005) fired.push_back({texts.index(text), rounded(weight, 100.0)});
    json why = json::array();
    for (const std::string& objection : objections(c, network))
      why.push_back(texts.index(objection));
    candidates.push_back({{"link", c.link.link},
                          {"at", point(network.at(c.link, c.along).position)},
                          {"likelihood", rounded(c.likelihood, 10.0)},
                          {"p", rounded(c.probability, 1e4)},
                          {"objections", std::move(why)},
                          {"rules", std::move(fired)}});
  }
  return candidates;
}

json fixes_of(const MatchedTrack& track, const mapmatch::RoadNetwork& network,
              const mapmatch::RuleBases& rules, Texts& texts, std::vector<bool>& used) {
  json fixes = json::array();
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    const mapmatch::MatchResult& r = track.results[i];
    if (r.refusal == mapmatch::FixRefusal::not_finite) continue;
    const bool refused = r.refusal != mapmatch::FixRefusal::none;
    json fix{{"t", to_seconds(track.fixes[i].stamp - track.fixes.front().stamp)},
             {"place", point(network.to_local(track.fixes[i].position))},
             {"phase", refused ? "not used" : to_string(r.phase)},
             {"explanation", explanation(r, network)},
             {"candidates", json::array()}};
    if (!refused) fix["candidates"] = candidates_of(r, network, rules, texts, used);
    if (r.on_road && !refused) {
      fix["matched"] = point(r.point.position);
      fix["p"] = rounded(r.probability, 1e4);
    }
    fixes.push_back(std::move(fix));
  }
  return fixes;
}

// Inside a script element "</" would end it, and "<!--" would hide its end, so that every "<" is
// escaped.
std::string script_safe(std::string text) {
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace

void write_match_html(const std::filesystem::path& file, const MatchedTrack& track,
                      const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules) {
  Texts texts;
  std::vector<bool> used(network.size(), false);
  std::vector<Eigen::Vector2d> places;
  for (const mapmatch::VehicleFix& fix : track.fixes)
    places.push_back(network.to_local(fix.position));
  json data{{"fixes", fixes_of(track, network, rules, texts, used)},
            {"roads", roads_about(network, box_about(places, surroundings), used)}};
  data["texts"] = texts.all();
  const std::string_view script = web::match_script();
  // Names in a map may contain anything, including invalid UTF-8.
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  evaluation::write_text(
      file,
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<title>maploop match</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<style>" +
          std::string(web::match_style()) +
          "</style></head><body>\n<main id=\"map\"></main>\n<aside id=\"panel\">" +
          (script.empty() ? "No map: this maploop was built without npm."
                          : "This map needs JavaScript.") +
          "</aside>\n<script type=\"application/json\" id=\"match\">" + script_safe(text) +
          "</script>\n<script>" + std::string(script) + "</script>\n</body></html>\n");
}

}  // namespace maploop::match
