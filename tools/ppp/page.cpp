#include "tools/ppp/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "tools/ppp/page_data.h"
#include "tools/web/html.h"
#include "tools/web/page.h"
#include "tools/web/stanford.h"
#include "tools/web/table.h"

namespace maploop::gnss {

using namespace maploop::ppp;
using web::Event;
using web::heading;
using web::Line;
using web::Plot;

namespace {

using Rows = std::vector<EpochRow>;

constexpr const char* gps_time = "GPS time";

// A line of a quantity of the epochs; unknown where it has none.
struct Quantity {
  std::string name;
  std::function<double(const PppSolution&)> value;
};

Plot over_time(const std::string& title, const std::string& unit, const Rows& rows,
               const std::vector<Quantity>& quantities, Line::Look look = Line::Look::solid) {
  Plot plot{title, gps_time, unit};
  plot.over_time = true;
  for (const Quantity& q : quantities) {
    std::vector<double> seconds, values;
    for (const EpochRow& row : rows) {
      seconds.push_back(row.second);
      values.push_back(row.solution ? q.value(*row.solution) : unknown);
    }
    const auto kept = web::thinned(values.size(), {&values});
    plot.lines.push_back({q.name, web::chosen(seconds, kept), web::chosen(values, kept), look});
  }
  return plot;
}

Plot satellites(const Rows& rows) {
  return over_time(
      "Satellites", "number", rows,
      {{"measured", [](const auto& s) { return static_cast<double>(s.satellites.size()); }},
       {"used", [](const auto& s) { return s.satellites_used; }},
       {"integer ambiguities", [](const auto& s) { return s.integers.used; }}},
      Line::Look::steps);
}

// Whether integers were searched for.
bool searched(const PppSolution& s) {
  return s.integers.success_rate > 0.0;
}

// By how much more the second best integers contradict the real-valued ambiguities than the best
// do, and how much the best do; none if they were never searched for.
std::vector<Plot> integers(const Rows& rows) {
  const auto is_searched = [](const EpochRow& r) { return r.solved() && searched(*r.solution); };
  if (std::none_of(rows.begin(), rows.end(), is_searched)) return {};
  const auto where_searched = [](auto value) {
    return [value](const PppSolution& s) { return searched(s) ? value(s.integers) : unknown; };
  };
  return {over_time("Margin of integers", "variances, at most 100", rows,
                    {{"margin",
                      where_searched([](const auto& i) { return std::min(i.margin, 100.0); })}}),
          over_time("Misfit of integers", "variances", rows,
                    {{"misfit", where_searched([](const auto& i) { return i.misfit; })}})};
}

Plot dilution(const Rows& rows) {
  return over_time("Dilution of precision", "1", rows,
                   {{"position", [](const auto& s) { return dilutions(s).position; }},
                    {"horizontal", [](const auto& s) { return dilutions(s).horizontal; }},
                    {"vertical", [](const auto& s) { return dilutions(s).vertical; }}});
}

Plot zenith_delay(const Rows& rows) {
  std::vector<double> seconds, delay, low, high;
  for (const EpochRow& row : rows) {
    const bool known = row.solved() && row.solution->zenith_delay > 0.0;
    seconds.push_back(row.second);
    delay.push_back(known ? row.solution->zenith_delay : unknown);
    const double sigma = known ? row.solution->zenith_delay_sigma : unknown;
    low.push_back(delay.back() - sigma);
    high.push_back(delay.back() + sigma);
  }
  const auto kept = web::thinned(delay.size(), {&delay});
  const auto some = [&](const std::vector<double>& values) { return web::chosen(values, kept); };
  Plot plot{"Zenith delay of the troposphere", gps_time, "m"};
  plot.lines = {{"zenith delay", some(seconds), some(delay)}};
  plot.bands = {{"1 sigma", some(seconds), some(low), some(high)}};
  plot.over_time = true;
  return plot;
}

// A line for each status; an epoch ends that of the status before.
Plot ground_track(const Rows& rows, const PppResult& result) {
  Plot plot{"Way", "east, m", "north, m", {}, true};
  std::optional<Eigen::Vector3d> origin;
  Eigen::Matrix3d R;
  Line truth{"truth"};
  std::map<PppStatus, Line> lines;
  PppStatus before = PppStatus::none;
  const auto add = [](Line& line, double second, const Eigen::Vector3d& enu) {
    line.add(enu.x(), enu.y());
    line.time.push_back(second);
  };
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(unknown);
  const std::size_t step = 1 + rows.size() / 10'000;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EpochRow& row = rows[i];
    if (row.solution != nullptr && i % step != 0) continue;
    const PppStatus status = row.solved() ? row.solution->status : PppStatus::none;
    if (status != PppStatus::none && !origin) {
      origin = row.solution->position;
      R = rotation_enu_ecef(geodetic_from_ecef(*origin));
    }
    const auto enu = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(R * (p - *origin)); };
    if (status != PppStatus::none) lines.try_emplace(status, Line{std::string(to_string(status))});
    for (auto& [of, line] : lines) {
      const bool ends = of == before && status != PppStatus::none;
      if (of == status || ends) {
        add(line, row.second, enu(row.solution->position));
      } else if (!line.x.empty() && std::isfinite(line.x.back())) {
        add(line, row.second, nowhere);
      }
    }
    before = status;
    if (!result.truth || row.solution == nullptr || !origin) continue;
    const auto place = result.truth->at(row.solution->time);
    if (place || !truth.x.empty()) add(truth, row.second, place ? enu(*place) : nowhere);
  }
  if (!truth.x.empty()) plot.lines.push_back(std::move(truth));
  for (auto& [status, line] : lines) plot.lines.push_back(std::move(line));
  return plot;
}

// Of epochs that move.
Plot across(const Score& score, const Score& without_map, GpsTime first) {
  Plot plot{"Error across the way", gps_time, "m"};
  plot.over_time = true;
  const auto line_of = [&](const char* name, const Score& of) {
    Line line{name};
    for (const ErrorAt& e : of.errors())
      line.add(to_seconds(e.time - first), e.moves ? e.travel.y() : unknown);
    return line;
  };
  plot.lines = {line_of("with the map", score), line_of("without", without_map)};
  return plot;
}

Plot stanford(const Score& score, double integrity_risk) {
  const char* names[3] = {"along", "across", "up"};
  std::vector<Line> lines;
  for (int i = 0; i < 3; ++i) {
    Line line{names[i], {}, {}, Line::Look::points};
    for (const ErrorAt& e : score.errors()) line.add(std::abs(e.travel[i]), e.protection[i]);
    lines.push_back(std::move(line));
  }
  return web::stanford_plot(
      fmt::format("Stanford plot: {} of {} errors beyond their level, risk {:g}",
                  score.misleading(), 3 * score.errors().size(), integrity_risk),
      std::move(lines));
}

// Missing epochs, and what the filter said, for as long as it said it.
std::vector<Event> events(const Rows& rows) {
  std::vector<Event> list;
  std::string said;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EpochRow& row = rows[i];
    if (row.solution == nullptr) {
      list.push_back(
          {rows[i - 1].second, rows[i + 1].second, Event::Level::warning, "no observations"});
      said.clear();
      continue;
    }
    const std::string& message = row.solution->message;
    if (!message.empty() && message == said) {
      list.back().to = row.second;
    } else if (!message.empty()) {
      list.push_back({row.second, row.second,
                      row.solved() ? Event::Level::note : Event::Level::error, message});
    }
    said = message;
  }
  return list;
}

std::string refusals(const Solutions& solutions) {
  std::map<std::string, int> counts;
  for (const PppSolution& s : solutions) {
    for (const SatelliteReport& r : s.satellites) {
      if (r.refused != PppRefusal::none) ++counts[std::string(to_string(r.refused))];
      if (r.slip != PppSlip::none) ++counts["slip: " + std::string(to_string(r.slip))];
    }
  }
  std::vector<web::Row> rows;
  rows.reserve(counts.size());
  for (const auto& [why, count] : counts) rows.push_back({why, std::to_string(count)});
  return web::table({"refused, or begun anew", "satellites and epochs"}, rows);
}

}  // namespace

std::string to_page(const std::string& title, const std::vector<std::string>& summary,
                    const PppResult& result, double integrity_risk) {
  const Rows rows = epoch_rows(result.solutions);
  const GpsTime first = result.solutions.front().time;
  const double time_of_day = std::fmod(seconds_of_week(first), 86'400.0);
  const std::vector<Plot> of_integers = integers(rows);
  web::Page page(title);
  page.add("<section class=\"verdict\">");
  for (const std::string& line : summary) page.add(web::paragraph(line));
  page.add("</section>\n").add_contents().add_timeline(events(rows), time_of_day);
  page.add(heading("Position") +
           web::paragraph("East, north and up, coloured by the status of each epoch. Drag across a "
                          "chart to look at a part of the time; a double click shows all of it."))
      .add_place("positions", positions_json(rows, result))
      .add_overview(ground_track(rows, result));
  if (result.score && !result.score->errors().empty()) {
    std::vector<Plot> plots;
    if (result.without_map) plots.push_back(across(*result.score, *result.without_map, first));
    plots.push_back(stanford(*result.score, integrity_risk));
    page.add(heading("Protection levels")).add(plots);
  }
  page.add(heading("Number and geometry of the satellites"))
      .add({satellites(rows), dilution(rows)})
      .add(heading("Sky, signals and residuals"))
      .add_place("satellites", satellites_json(rows))
      .add(of_integers.empty() ? "" : heading("Integer ambiguities"))
      .add(of_integers)
      .add(heading("Troposphere"))
      .add({zenith_delay(rows)})
      .add(heading("Events"))
      .add_events()
      .add(refusals(result.solutions));
  return page.text();
}

}  // namespace maploop::gnss
