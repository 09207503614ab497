#include "tools/report/ppp_section.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "tools/report/error_plot.h"
#include "tools/report/frame.h"
#include "tools/report/text.h"

namespace maploop::report {
namespace {

using web::Line;
using web::Plot;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// The error of one epoch with a position.
struct EpochError {
  double second = 0.0;
  Eigen::Vector3d enu = Eigen::Vector3d::Constant(unknown);  // m, against the truth
  Eigen::Vector3d sigma;                                     // m
  double nees = unknown;                                     // for three dimensions
  bool converged = false;
};

std::vector<EpochError> errors_of(const ReplayReport& r) {
  const auto truth = truth_of(r);
  const LocalFrame frame(origin_of(r));
  const Time first = first_of(r);
  std::vector<EpochError> errors;
  for (const auto& [stamp, state] : r.ppp) {
    if (state.status == PppStatus::none) continue;
    EpochError e;
    e.second = to_seconds(stamp - first);
    e.sigma = state.position_covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    e.converged = state.status == PppStatus::converged;
    if (const auto pose = truth ? truth->pose(stamp) : std::nullopt) {
      e.enu = frame.to_enu(state.position) - *pose * r.antenna;
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

std::string coverage(const ReplayReport& r) {
  std::array<std::size_t, ppp_status_count> counts{};
  double used = 0.0;
  for (const auto& [stamp, state] : r.ppp) {
    ++counts[static_cast<std::size_t>(state.status)];
    used += state.satellites_used;
  }
  const auto n = static_cast<double>(r.ppp.size());
  const auto of = [&](PppStatus s) { return counts[static_cast<std::size_t>(s)]; };
  const std::size_t solved = of(PppStatus::converged) + of(PppStatus::converging);
  std::string text = std::to_string(r.ppp.size()) + " epochs, " +
                     figure(100.0 * static_cast<double>(solved) / n, 1, " %") +
                     " with a position: " + std::to_string(of(PppStatus::converged)) +
                     " converged, " + std::to_string(of(PppStatus::converging)) + " converging";
  if (r.result.ppp && r.result.ppp->converged_after >= 0.0)
    text += "; converged after " + figure(r.result.ppp->converged_after, 0, " s");
  return paragraph(text + ". " + figure(used / n, 1) + " satellites used on average.");
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
    ErrorSeries series{axes[static_cast<std::size_t>(i)], "m", "PPP", {}, {}, {}};
    for (const EpochError& e : errors) {
      series.seconds.push_back(e.second);
      series.error.push_back(e.enu[i]);
      series.sigma.push_back(e.sigma[i]);
    }
    plots.push_back(error_plot(series));
  }
  return plots;
}

Plot satellites(const ReplayReport& r) {
  Line used{"used", {}, {}}, measured{"measured", {}, {}};
  const Time first = first_of(r);
  for (const auto& [stamp, state] : r.ppp) {
    const double second = to_seconds(stamp - first);
    used.x.push_back(second);
    used.y.push_back(state.satellites_used);
    measured.x.push_back(second);
    measured.y.push_back(static_cast<double>(state.satellites.size()));
  }
  return {"Satellites", "s", "number", {std::move(used), std::move(measured)}};
}

std::string refusals(const ReplayReport& r) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [stamp, state] : r.ppp) {
    for (const PppSatellite& s : state.satellites) {
      if (s.refusal != PppRefusal::none) ++counts[std::string(to_string(s.refusal))];
      if (s.slip != PppSlip::none) ++counts["begun anew: " + std::string(to_string(s.slip))];
    }
  }
  if (counts.empty()) return {};
  std::vector<web::Row> rows;
  for (const auto& [why, count] : counts) rows.push_back({why, std::to_string(count)});
  return folded("Satellites refused or begun anew",
                web::table({"why", "satellites and epochs"}, rows));
}

}  // namespace

void add_ppp(web::Page& page, const ReplayReport& r) {
  if (r.ppp.empty()) return;
  const std::vector<EpochError> errors = errors_of(r);
  page.add("<h2>Precise point positioning</h2>\n" + coverage(r) + accuracy(errors));
  std::vector<Plot> plots;
  if (!errors.empty()) plots = error_plots(errors);
  plots.push_back(satellites(r));
  page.add(plots).add(refusals(r));
}

}  // namespace maploop::report
