#include "tools/match/match_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "mapmatch/doubt_collector.h"
#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/text_lines.h"

namespace maploop::match {
namespace {

// Returns the mean P(link) of a bin and its share of right matches.
std::pair<double, double> said_and_right(const Reliability& r, std::size_t bin) {
  const auto n = static_cast<double>(r.fixes[bin]);
  return {r.p_sum[bin] / n, static_cast<double>(r.right[bin]) / n};
}

nlohmann::json to_json(const Tally& t) {
  return {{"fixes", t.fixes}, {"right", t.share()}, {"coverage", t.coverage()}};
}

std::string line(const char* what, const Tally& t) {
  return fmt::format("  right way, {:10} {:7.2f} % of {} fixes, coverage {:.2f} %\n", what,
                     100.0 * t.share(), t.fixes, 100.0 * t.coverage());
}

}  // namespace

MatchedFix on_segment(const mapmatch::RoadNetwork& network, mapmatch::DirectedLink link,
                      std::uint32_t vertex, double p) {
  const auto [a, b] = network.nodes(link, vertex);
  return {network.road_at(vertex).way_id, a, b, p, link};
}

Labels read_labels(const std::filesystem::path& file) {
  const std::string text = evaluation::read_text(file);
  evaluation::NamedColumns rows(text, file.string());
  const auto column = [&](const char* name) {
    return rows.column(name, "labels have the columns frame,way_id,node_a,node_b,conf");
  };
  const std::size_t frame = column("frame"), way = column("way_id"), conf = column("conf"),
                    a = column("node_a"), b = column("node_b");
  const auto id = [&](std::size_t of) { return rows.number<std::int64_t>(of); };
  Labels labels;
  while (rows.next())
    labels[rows.number<std::size_t>(frame)] = {id(way), id(a), id(b), id(conf) == 1};
  return labels;
}

SegmentLinks::SegmentLinks(const mapmatch::RoadNetwork& network) {
  for (std::uint32_t link = 0; link < network.size(); ++link) {
    const std::uint32_t first = network.link(link).first_vertex;
    for (std::uint32_t v = first; v + 1 < first + network.link(link).vertex_count; ++v) {
      for (const bool forward : {true, false})
        links_[network.nodes({link, forward}, v)] = {link, forward};
    }
  }
}

std::optional<mapmatch::DirectedLink> SegmentLinks::find(std::int64_t node_a,
                                                         std::int64_t node_b) const {
  const auto found = links_.find({node_a, node_b});
  return found == links_.end() ? std::nullopt : std::optional(found->second);
}

void SegmentLinks::look_up(Labels& labels) const {
  for (auto& [row, label] : labels) label.link = find(label.node_a, label.node_b);
}

Tally& Tally::operator+=(const Tally& more) {
  fixes += more.fixes;
  matched += more.matched;
  right += more.right;
  return *this;
}

MatchScore& MatchScore::operator+=(const MatchScore& more) {
  all += more.all;
  certain += more.certain;
  reliability += more.reliability;
  lacking_fixes += more.lacking_fixes;
  lacking_p_sum += more.lacking_p_sum;
  return *this;
}
Reliability& Reliability::operator+=(const Reliability& more) {
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    fixes[k] += more.fixes[k];
    right[k] += more.right[k];
    p_sum[k] += more.p_sum[k];
  }
  return *this;
}

void MatchScore::add(const std::vector<MatchedFix>& matched, const std::vector<std::size_t>& rows,
                     const Labels& labels) {
  for (std::size_t i = 0; i < matched.size(); ++i) {
    const auto label = labels.find(rows[i]);
    if (label == labels.end()) continue;
    const bool right = matched[i].way_id == label->second.way_id;
    const auto count = [&](Tally& tally) {
      ++tally.fixes;
      tally.matched += matched[i].way_id ? 1 : 0;
      tally.right += right ? 1 : 0;
    };
    count(all);
    if (label->second.certain) count(certain);
    if (!label->second.link) {
      ++lacking_fixes;
      lacking_p_sum += matched[i].p_link;
    }
    if (!matched[i].way_id) continue;
    const auto bin = std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * matched[i].p_link));
    ++reliability.fixes[bin];
    const auto& driven = label->second.link;
    const bool same = driven && matched[i].link ? driven == matched[i].link : right;
    reliability.right[bin] += same ? 1 : 0;
    reliability.p_sum[bin] += matched[i].p_link;
  }
}

MatchedFix matched_fix(const mapmatch::MatchResult& r, const mapmatch::RoadNetwork& network) {
  if (!r.on_road || r.refusal != mapmatch::FixRefusal::none) return {};
  return on_segment(network, r.link, r.point.vertex, r.probability);
}

std::vector<MatchedFix> match_track(mapmatch::Matcher& matcher, const Track& track,
                                    const MatchOutputs& outputs) {
  std::optional<mapmatch::DoubtCollector> collector;
  if (outputs.doubts) collector.emplace(matcher.network(), matcher.parameters());
  const auto take = [&](std::span<const MapDoubt> some) {
    outputs.doubts->insert(outputs.doubts->end(), some.begin(), some.end());
  };
  std::vector<MatchedFix> matched;
  matched.reserve(track.size());
  for (const mapmatch::VehicleFix& fix : track) {
    const mapmatch::MatchResult& result = matcher.add(fix);
    if (outputs.history) outputs.history->add(result, matcher);
    if (collector) take(collector->add(result, fix));
    matched.push_back(matched_fix(result, matcher.network()));
  }
  if (collector) take(collector->finish());
  return matched;
}

std::vector<MatchedFix> match_later(const mapmatch::MatchHistory& history, Duration lag,
                                    const mapmatch::RoadNetwork& network) {
  std::vector<MatchedFix> matched;
  for (const mapmatch::MatchResult& result : history.judged_after(lag))
    matched.push_back(matched_fix(result, network));
  return matched;
}

TimedMatch timed_match(const MapMatch& match) {
  if (!match.on_road) return {match.stamp, {}};
  return {match.stamp, {match.way_id, match.node_a, match.node_b, match.probability, match.link}};
}

std::optional<std::size_t> frame_at(Time t, const std::vector<Time>& stamps) {
  constexpr Duration near = std::chrono::milliseconds(60);  // half a frame period, with margin
  if (stamps.empty()) return std::nullopt;
  auto at = std::lower_bound(stamps.begin(), stamps.end(), t);
  if (at == stamps.end() || (at != stamps.begin() && t - *std::prev(at) < *at - t)) --at;
  if (std::chrono::abs(*at - t) > near) return std::nullopt;
  return static_cast<std::size_t>(at - stamps.begin());
}

MatchScore score_matches(const std::vector<TimedMatch>& matches, const std::vector<Time>& stamps,
                         const Labels& labels) {
  std::vector<MatchedFix> matched;
  std::vector<std::size_t> rows;
  for (const TimedMatch& match : matches) {
    const auto frame = frame_at(match.stamp, stamps);
    if (!frame) continue;
    matched.push_back(match.matched);
    rows.push_back(*frame);
  }
  MatchScore score;
  score.add(matched, rows, labels);
  return score;
}

std::string to_text(const MatchScore& score) {
  return line("all labels", score.all) + line("conf = 1", score.certain);
}

double Reliability::calibration_error() const {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < fixes.size(); ++k) {
    sum += std::abs(p_sum[k] - static_cast<double>(right[k]));
    count += static_cast<double>(fixes[k]);
  }
  return count > 0.0 ? sum / count : 0.0;
}

std::string to_text(const Reliability& r, std::string_view what) {
  std::string text = fmt::format("  P(link) said, mean -> share on the right {} (fixes)\n", what);
  for (std::size_t k = 0; k < r.fixes.size(); ++k) {
    if (r.fixes[k] == 0) continue;
    const auto [said, right] = said_and_right(r, k);
    text += fmt::format("  {:.1f} to {:.1f}: {:.3f} -> {:.3f} ({})\n", 0.1 * static_cast<double>(k),
                        0.1 * static_cast<double>(k + 1), said, right, r.fixes[k]);
  }
  text += fmt::format("  expected calibration error {:.4f}\n", r.calibration_error());
  return text;
}

nlohmann::json to_json(const MatchScore& score) {
  nlohmann::json reliability = nlohmann::json::array();
  const Reliability& r = score.reliability;
  for (std::size_t k = 0; k < r.fixes.size(); ++k) {
    if (r.fixes[k] == 0) continue;
    const auto [said, right] = said_and_right(r, k);
    reliability.push_back({{"p_said", said}, {"right", right}, {"fixes", r.fixes[k]}});
  }
  return {{"all", to_json(score.all)},
          {"certain", to_json(score.certain)},
          {"reliability", reliability},
          {"calibration_error", r.calibration_error()}};
}

}  // namespace maploop::match
