#include "tools/ppp/summary.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>

#include "ppp/unused_signals.h"

namespace maploop::gnss {

using namespace maploop::ppp;
using nlohmann::json;

namespace {

json to_json(const Accuracy& a, std::optional<double> below) {
  const auto figure = [&](double value) { return a.solved > 0 ? json(value) : json(nullptr); };
  return {{"epochs", a.with_truth},
          {"solved", a.solved},
          {"coverage", a.coverage()},
          {"horizontal_rmse_m", figure(a.horizontal_rmse)},
          {"horizontal_95_m", figure(a.horizontal_95)},
          {"across_rmse_m", figure(a.across_rmse)},
          {"up_rmse_m", figure(a.up_rmse)},
          {"mean_enu_m", {figure(a.mean_enu.x()), figure(a.mean_enu.y()), figure(a.mean_enu.z())}},
          {"horizontal_rmse_without_mean_m", figure(a.horizontal_rmse_without_mean)},
          {"last_3d_m", figure(a.three_d_last)},
          {"nees", figure(a.nees)},
          {"fixed", a.fixed},
          {"wrongly_fixed", a.wrongly_fixed},
          {"seconds_to_stay_below_0.1_m", below ? json(*below) : json(nullptr)}};
}

json to_json(const MapAidedFilter& filter, std::size_t matched) {
  json feedback;
  for (std::size_t i = 0; i < map_use_count; ++i) {
    const auto use = static_cast<MapUse>(i);
    feedback[std::string(to_string(use))] = filter.count(use);
  }
  return {{"matched", matched},
          {"feedback", std::move(feedback)},
          {"restorations", filter.restorations()}};
}

json to_json(const MapComparison& comparison) {
  const auto errors = [](const MapComparison::Errors& e) -> json {
    return {{"across_rmse_m", e.across_rmse},
            {"horizontal_rmse_m", e.horizontal_rmse},
            {"across_stays_below_1.5_m_after_s", e.stays_below_after}};
  };
  return {{"epochs", comparison.epochs()},
          {"with", errors(comparison.aided())},
          {"without", errors(comparison.free())}};
}

std::string map_line(const MapAidedFilter& filter, std::size_t matched, std::size_t epochs) {
  std::string line = fmt::format("{} of {} epochs on a road of the map; fed back: {} used", matched,
                                 epochs, filter.count(MapUse::used));
  for (std::size_t i = 1; i < map_use_count; ++i) {
    const auto use = static_cast<MapUse>(i);
    if (use != MapUse::nothing_fed_back && filter.count(use) > 0)
      line += fmt::format(", {} {}", filter.count(use), to_string(use));
  }
  line += fmt::format("; forgotten as a wrong road's: {}", filter.restorations());
  if (matched == 0)
    line += "; is it the map of this area? 'maploop map info' says where its middle is";
  return line;
}

void append_score(std::vector<std::string>& lines, const PppResult& r, double integrity_risk) {
  lines.push_back("against the truth: " + to_text(r.score->accuracy(r.scored_from)));
  lines.push_back(
      fmt::format("{} of {} errors along, across and up are beyond their protection level "
                  "(integrity risk {:g})",
                  r.score->misleading(), 3 * r.score->errors().size(), integrity_risk));
  if (r.without_map)
    lines.push_back("the same without the map: " + to_text(r.without_map->accuracy(r.scored_from)));
  const auto below = r.score->time_to_stay_below(0.1);
  lines.push_back(below ? fmt::format("3-D error stays below 0.1 m after {:.1f} min", *below / 60)
                        : "3-D error does not stay below 0.1 m");
}

// Counts the epochs with integer ambiguities and, of the others, the reasons.
std::string integer_line(const Solutions& solutions) {
  std::array<std::size_t, count_of<IntegerOutcome>> counts{};
  for (const PppSolution& s : solutions) ++counts[static_cast<std::size_t>(s.integers.outcome)];
  const auto fixed = static_cast<std::size_t>(
      std::ranges::count(solutions, PppStatus::fixed, &PppSolution::status));
  std::string line =
      fmt::format("integer ambiguities in {} of {} epochs;", fixed, solutions.size());
  if (counts.back() > fixed)
    line += fmt::format(" {} with too few of them for the position,", counts.back() - fixed);
  for (std::size_t i = 0; i + 1 < counts.size(); ++i) {
    line += fmt::format("{} {} {}", i > 0 ? "," : "", counts[i],
                        to_string(static_cast<IntegerOutcome>(i)));
  }
  return line;
}

std::array<std::size_t, count_of<HeightUse>> height_uses(const Solutions& solutions) {
  std::array<std::size_t, count_of<HeightUse>> counts{};
  for (const PppSolution& s : solutions) ++counts[static_cast<std::size_t>(s.height_use)];
  return counts;
}

std::string height_line(const Solutions& solutions) {
  const auto counts = height_uses(solutions);
  std::string line =
      fmt::format("height of the ground used in {} of {} epochs", counts.front(), solutions.size());
  for (std::size_t i = 1; i < counts.size(); ++i) {
    if (counts[i] > 0)
      line += fmt::format(", {} {}", counts[i], to_string(static_cast<HeightUse>(i)));
  }
  return line;
}

json heights_to_json(const Solutions& solutions) {
  const auto counts = height_uses(solutions);
  json all;
  for (std::size_t i = 0; i < counts.size(); ++i)
    all[std::string(to_string(static_cast<HeightUse>(i)))] = counts[i];
  return all;
}

template <class File>
void append_refusals(const File& file, std::vector<std::string>& lines) {
  if constexpr (requires { file.refused; }) {
    if (file.refused == 0) return;
    std::string line = fmt::format("{}: {} refused", file.file, file.refused);
    if constexpr (requires { file.refusals.front(); })
      if (!file.refusals.empty()) line += ", first: " + file.refusals.front();
    lines.push_back(std::move(line));
  }
}

}  // namespace

std::vector<std::string> summary_lines(const PppRun& run, const PppResult& r, double integrity_risk,
                                       bool on_map, const GnssFiles& files) {
  const std::size_t epochs = r.solutions.size();
  std::vector<std::string> lines{
      fmt::format("{} orbits and clocks, {}, {}, {}, systems {}",
                  run.setup().precise() ? "precise" : "broadcast",
                  run.setup().one_frequency() ? "one frequency" : "two frequencies",
                  to_string(run.setup().parameters().motion), to_string(run.direction()),
                  run.setup().parameters().systems),
      fmt::format("{} of {} epochs have a position ({:.1f} %); filter {:.3f} s, {:.3f} ms an epoch",
                  r.solved, epochs,
                  100.0 * static_cast<double>(r.solved) / static_cast<double>(epochs),
                  run.seconds(), 1e3 * run.seconds() / static_cast<double>(epochs))};
  if (r.bridged > 0) {
    lines.push_back(
        fmt::format("{} epochs with fewer than four satellites are bridged", r.bridged));
  }
  if (run.setup().parameters().integers && run.setup().precise() && !run.setup().one_frequency())
    lines.push_back(integer_line(r.solutions));
  if (run.setup().never_converges()) {
    lines.push_back(
        "on one frequency with broadcast orbits the position does not converge to 0.1 m: "
        "decimetres to metres remain");
  }
  if (r.score) append_score(lines, r, integrity_risk);
  if (on_map) lines.push_back(map_line(run.filter(), r.matched, epochs));
  if (const HeightModel* heights = run.setup().heights()) {
    lines.push_back(height_line(r.solutions));
    for (const auto& problem : heights->problems()) lines.push_back(problem);
  }
  for (const auto& line : run.setup().missing_models()) lines.push_back(line);
  for (const auto& line : run.missing_products()) lines.push_back(line);
  for (const auto& line : unused_systems(run.setup().observations().header)) lines.push_back(line);
  for (const NavigationFile& file : files.navigation) {
    if (file.skipped > 0 && file.kepler.empty() && file.glonass.empty()) {
      lines.push_back(
          fmt::format("{}: {} messages are passed over, and others are not in it (SBAS and NavIC "
                      "are not used)",
                      file.file, file.skipped));
    }
  }
  visit_lists([&](auto list) {
    for (const auto& file : files.*list) append_refusals(file, lines);
  });
  if (leap_seconds(r.solutions.back().time).out_of_date)
    lines.push_back("the table of leap seconds ends before these data: UTC may be a second off");
  return lines;
}

json to_json(const PppRun& run, const PppResult& r, bool on_map) {
  json all = {{"epochs", r.solutions.size()},
              {"solved", r.solved},
              {"bridged", r.bridged},
              {"direction", to_string(run.direction())},
              {"filter_seconds", run.seconds()},
              {"missing_products", run.missing_products()},
              {"lacks", run.setup().missing_models()}};
  const auto scored = [&](const Score& score) {
    return to_json(score.accuracy(r.scored_from), score.time_to_stay_below(0.1));
  };
  if (r.score) all["truth"] = scored(*r.score);
  if (on_map) all["map"] = to_json(run.filter(), r.matched);
  if (r.without_map) all["map"]["truth_without_map"] = scored(*r.without_map);
  if (run.setup().heights() != nullptr) all["heights"] = heights_to_json(r.solutions);
  if (r.comparison) all["map"]["comparison"] = to_json(*r.comparison);
  return all;
}

}  // namespace maploop::gnss
