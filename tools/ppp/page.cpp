#include "tools/ppp/page.h"

#include <fmt/format.h>
#include <cmath>
#include <map>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"
#include "tools/web/html.h"
#include "tools/web/page.h"

namespace maploop::gnss {

using namespace maploop::ppp;
using web::Line;
using web::Plot;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double minutes(GpsTime t, GpsTime first) {
  return to_seconds(t - first) / 60.0;
}

void add(Line& line, double x, double y) {
  line.x.push_back(x);
  line.y.push_back(y);
}

Plot errors(const Score& score, GpsTime first) {
  Plot plot{"Error against the truth", "minutes", "m", {}, false};
  const char* names[3] = {"east", "north", "up"};
  for (int i = 0; i < 3; ++i) {
    Line line{names[i], {}, {}};
    for (const ErrorAt& e : score.errors()) add(line, minutes(e.time, first), e.enu[i]);
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

// Of epochs that move.
Plot across(const Score& score, const Score& without_map, GpsTime first) {
  Plot plot{"Error across the way", "minutes", "m", {}, false};
  const auto line_of = [&](const char* name, const Score& of) {
    Line line{name, {}, {}};
    for (const ErrorAt& e : of.errors()) {
      add(line, minutes(e.time, first), e.moves ? e.travel.y() : nan);
    }
    return line;
  };
  plot.lines = {line_of("with the map", score), line_of("without", without_map)};
  return plot;
}

// Errors beyond their protection level lie below the diagonal.
Plot stanford(const Score& score, double integrity_risk) {
  Plot plot{fmt::format("Stanford plot: {} of {} errors beyond their level, risk {:g}",
                        score.misleading(), 3 * score.errors().size(), integrity_risk),
            "error, m",
            "protection level, m",
            {},
            false};
  const char* names[3] = {"along", "across", "up"};
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    Line line{names[i], {}, {}, Line::Look::points};
    for (const ErrorAt& e : score.errors()) {
      add(line, std::abs(e.travel[i]), e.protection[i]);
      largest = std::max(largest, std::abs(e.travel[i]));
    }
    plot.lines.push_back(std::move(line));
  }
  plot.lines.push_back({"error = level", {0.0, largest}, {0.0, largest}});
  return plot;
}

Plot ground_track(const Solutions& solutions) {
  Plot plot{"Way", "east, m", "north, m", {Line{"position", {}, {}}}, true};
  const PppSolution* origin = nullptr;
  for (const PppSolution& s : solutions) {
    if (s.status == PppStatus::none) continue;
    if (!origin) origin = &s;
    const Eigen::Vector3d enu =
        rotation_enu_ecef(geodetic_from_ecef(origin->position)) * (s.position - origin->position);
    add(plot.lines[0], enu.x(), enu.y());
  }
  return plot;
}

Plot deviations(const Solutions& solutions, GpsTime first) {
  Plot plot{"Formal standard deviation", "minutes", "m", {}, false};
  Line horizontal{"horizontal", {}, {}}, up{"up", {}, {}};
  for (const PppSolution& s : solutions) {
    if (s.status == PppStatus::none) continue;
    const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(s.position));
    const Eigen::Matrix3d P = R * s.covariance * R.transpose();
    add(horizontal, minutes(s.time, first), std::sqrt(P(0, 0) + P(1, 1)));
    add(up, minutes(s.time, first), std::sqrt(P(2, 2)));
  }
  plot.lines = {horizontal, up};
  return plot;
}

Plot satellites(const Solutions& solutions, GpsTime first) {
  Plot plot{"Satellites", "minutes", "number", {}, false};
  Line used{"used", {}, {}}, measured{"measured", {}, {}}, integers{"integer ambiguities", {}, {}};
  for (const PppSolution& s : solutions) {
    add(used, minutes(s.time, first), s.satellites_used);
    add(integers, minutes(s.time, first), s.integers.used);
    add(measured, minutes(s.time, first), static_cast<double>(s.satellites.size()));
  }
  plot.lines = {used, measured, integers};
  return plot;
}

// One line a system, broken between satellites.
template <class Value>
Plot per_system(const std::string& title, const Solutions& solutions, GpsTime first,
                Value&& value) {
  Plot plot{title, "minutes", "m", {}, false};
  std::map<Satellite, Line> lines;
  for (const PppSolution& s : solutions) {
    for (const SatelliteReport& r : s.satellites) {
      const double v = value(r);
      if (std::isfinite(v)) add(lines[r.satellite], minutes(s.time, first), v);
    }
  }
  std::map<System, Line> systems;
  for (const auto& [satellite, line] : lines) {
    Line& all = systems[satellite.system];
    all.name = std::string{letter(satellite.system)};
    all.x.insert(all.x.end(), line.x.begin(), line.x.end());
    all.y.insert(all.y.end(), line.y.begin(), line.y.end());
    add(all, nan, nan);
  }
  for (auto& [system, line] : systems) plot.lines.push_back(std::move(line));
  return plot;
}

// North is up, the horizon at 90.
Plot sky(const Solutions& solutions) {
  Plot plot{"Sky: degrees from the zenith", "east", "north", {}, true};
  Line horizon{"horizon", {}, {}};
  for (int a = 0; a <= 360; a += 5) {
    add(horizon, 90.0 * std::sin(radians(a)), 90.0 * std::cos(radians(a)));
  }
  plot.lines.push_back(horizon);
  std::map<Satellite, Line> lines;
  for (const PppSolution& s : solutions) {
    for (const SatelliteReport& r : s.satellites) {
      if (r.elevation <= 0.0) continue;
      const double zenith = 90.0 - degrees(r.elevation);
      add(lines[r.satellite], zenith * std::sin(r.azimuth), zenith * std::cos(r.azimuth));
    }
  }
  std::map<System, Line> systems;
  for (const auto& [satellite, line] : lines) {
    Line& all = systems[satellite.system];
    all.name = std::string{letter(satellite.system)};
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      // A satellite that sets and rises again leaves a gap.
      if (i > 0 && std::hypot(line.x[i] - line.x[i - 1], line.y[i] - line.y[i - 1]) > 8.0) {
        add(all, nan, nan);
      }
      add(all, line.x[i], line.y[i]);
    }
    add(all, nan, nan);
  }
  for (auto& [system, line] : systems) plot.lines.push_back(std::move(line));
  return plot;
}

std::string refusals(const Solutions& solutions) {
  std::map<std::string, int> counts;
  for (const PppSolution& s : solutions) {
    for (const SatelliteReport& r : s.satellites) {
      if (r.refused != PppRefusal::none) ++counts[std::string(to_string(r.refused))];
      if (r.slip != PppSlip::none) ++counts["slip: " + std::string(to_string(r.slip))];
    }
  }
  std::string text =
      "<table><tr><th>refused, or begun anew</th><th>satellites and epochs</th></tr>";
  for (const auto& [why, count] : counts) {
    text += "<tr><td>" + web::escaped(why) + "</td><td>" + std::to_string(count) + "</td></tr>";
  }
  return text + "</table>";
}

}  // namespace

std::string to_page(const std::string& heading, const std::vector<std::string>& summary,
                    const Solutions& solutions, const Score* score, const Score* without_map,
                    double integrity_risk) {
  std::string body;
  for (const std::string& line : summary) body += "<p>" + web::escaped(line) + "</p>";
  body += refusals(solutions);
  std::vector<Plot> plots;
  if (!solutions.empty()) {
    const GpsTime first = solutions.front().time;
    if (score && !score->errors().empty()) {
      plots.push_back(errors(*score, first));
      if (without_map) plots.push_back(across(*score, *without_map, first));
      plots.push_back(stanford(*score, integrity_risk));
    }
    plots.push_back(ground_track(solutions));
    plots.push_back(deviations(solutions, first));
    plots.push_back(satellites(solutions, first));
    plots.push_back(per_system("Residuals of phase", solutions, first, [](const auto& r) {
      return r.phase_used ? r.phase_residual : nan;
    }));
    plots.push_back(per_system("Residuals of code", solutions, first,
                               [](const auto& r) { return r.code_used ? r.code_residual : nan; }));
    plots.push_back(sky(solutions));
  }
  return web::Page(heading).add(body).add(plots).text();
}

}  // namespace maploop::gnss
