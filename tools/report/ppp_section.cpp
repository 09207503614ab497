#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tools/report/sections.h"
#include "tools/web/html.h"
#include "tools/web/table.h"

namespace maploop::report {
namespace {

using tools::PppEpochs;
using web::figure;
using web::paragraph;
using web::Plot;
using States = std::map<Time, PppState>;

// The error of one epoch with a position.
struct EpochError {
  double second = 0.0;
  Eigen::Vector3d enu = Eigen::Vector3d::Constant(unknown);  // m, against the truth
  Eigen::Vector3d sigma;                                     // m
  double nees = unknown;                                     // for three dimensions
  bool converged = false;
};

std::vector<EpochError> errors_of(const Scene& scene) {
  const fusion::FusionParameters& p = scene.report.config.fusion;
  const Eigen::Vector3d antenna(p.gnss_lever_forward, p.gnss_lever_left, p.gnss_lever_up);
  std::vector<EpochError> errors;
  for (const auto& [stamp, state] : scene.report.pass.ppp_states) {
    if (state.status == PppStatus::none) continue;
    EpochError e;
    e.second = scene.second(stamp);
    e.sigma = state.position_covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    e.converged = state.status >= PppStatus::converged;
    if (const auto pose = scene.truth ? scene.truth->pose(stamp) : std::nullopt) {
      e.enu = scene.frame.to_enu(state.position) - *pose * antenna;
      e.nees = e.enu.dot(state.position_covariance.ldlt().solve(e.enu));
    }
    errors.push_back(e);
  }
  return errors;
}

web::Row accuracy_row(const char* name, const std::vector<EpochError>& errors,
                      bool converged_alone) {
  std::vector<double> horizontal;
  double squares = 0.0, up = 0.0, nees = 0.0;
  std::size_t within = 0;
  for (const EpochError& e : errors) {
    if (!e.enu.allFinite() || (converged_alone && !e.converged)) continue;
    horizontal.push_back(e.enu.head<2>().norm());
    squares += e.enu.head<2>().squaredNorm();
    up += e.enu.z() * e.enu.z();
    nees += e.nees;
    for (int i = 0; i < 3; ++i) within += std::abs(e.enu[i]) <= sigmas * e.sigma[i];
  }
  if (horizontal.empty()) return {name, "0", "-", "-", "-", "-", "-"};
  const auto n = static_cast<double>(horizontal.size());
  std::sort(horizontal.begin(), horizontal.end());
  return {name,
          std::to_string(horizontal.size()),
          figure(std::sqrt(squares / n), 3),
          figure(horizontal[static_cast<std::size_t>(0.95 * (n - 1.0))], 3),
          figure(std::sqrt(up / n), 3),
          figure(100.0 * static_cast<double>(within) / (3.0 * n), 1),
          figure(nees / n, 2)};
}

std::string coverage(const States& states) {
  const PppEpochs epochs(states);
  double used = 0.0;
  for (const auto& [stamp, state] : states) used += state.satellites_used;
  const auto n = static_cast<double>(states.size());
  const std::size_t fixed = epochs.of(PppStatus::fixed),
                    converged = epochs.of(PppStatus::converged) + fixed,
                    converging = epochs.of(PppStatus::converging);
  return paragraph(
      fmt::format("{} epochs, {:.1f} % with a position: {} converged{}, {} converging{}. {:.1f} "
                  "satellites used "
                  "on average.",
                  states.size(), 100.0 * static_cast<double>(converged + converging) / n, converged,
                  fixed > 0 ? fmt::format(" ({} with integer ambiguities)", fixed) : "", converging,
                  epochs.converged_after < 0.0
                      ? ""
                      : fmt::format("; converged after {:.0f} s", epochs.converged_after),
                  used / n));
}

std::string accuracy(const std::vector<EpochError>& errors) {
  const bool known = std::any_of(errors.begin(), errors.end(),
                                 [](const EpochError& e) { return e.enu.allFinite(); });
  if (!known) return paragraph("There is no truth at its epochs to score it with.");
  return web::table(
      {"", "epochs", "horizontal RMSE, m", "95 %, m", "up RMSE, m", "within 3 sigma, %",
       "NEES of 3"},
      {accuracy_row("all epochs", errors, false), accuracy_row("converged", errors, true)});
}

std::vector<Plot> error_plots(const std::vector<EpochError>& errors) {
  constexpr std::array axes{"east, PPP", "north, PPP", "up, PPP"};
  std::vector<Plot> plots;
  for (int i = 0; i < 3; ++i) {
    ErrorSeries series{axes[static_cast<std::size_t>(i)], "m", "PPP"};
    for (const EpochError& e : errors) {
      series.seconds.push_back(e.second);
      series.error.push_back(e.enu[i]);
      series.sigma.push_back(e.sigma[i]);
    }
    plots.push_back(error_plot(series));
  }
  return plots;
}

Plot satellites(const Scene& scene) {
  Plot plot{"Satellites", "s", "number", {{"used", {}, {}}, {"measured", {}, {}}}};
  plot.over_time = true;
  for (const auto& [stamp, state] : scene.report.pass.ppp_states) {
    plot.lines[0].add(scene.second(stamp), state.satellites_used);
    plot.lines[1].add(scene.second(stamp), static_cast<double>(state.satellites.size()));
  }
  return plot;
}

std::string refusals(const States& states) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [stamp, state] : states) {
    for (const PppSatellite& s : state.satellites) {
      if (s.refusal != PppRefusal::none) ++counts[std::string(to_string(s.refusal))];
      if (s.slip != PppSlip::none) ++counts["begun anew: " + std::string(to_string(s.slip))];
    }
  }
  if (counts.empty()) return {};
  std::vector<web::Row> rows;
  rows.reserve(counts.size());
  for (const auto& [why, count] : counts) rows.push_back({why, std::to_string(count)});
  return web::folded("Satellites refused or begun anew",
                     web::table({"why", "satellites and epochs"}, rows));
}

}  // namespace

void add_ppp(web::Page& page, const Scene& scene) {
  const States& states = scene.report.pass.ppp_states;
  if (states.empty()) return;
  const std::vector<EpochError> errors = errors_of(scene);
  page.add(web::heading(ppp_heading) + coverage(states) + accuracy(errors));
  std::vector<Plot> plots;
  if (!errors.empty()) plots = error_plots(errors);
  plots.push_back(satellites(scene));
  page.add(plots).add(refusals(states));
}

}  // namespace maploop::report
