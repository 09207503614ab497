#include <algorithm>

#include "tools/report/sections.h"
#include "tools/vehicle/vehicle_tool.h"
#include "tools/web/html.h"
#include "tools/web/table.h"

namespace maploop::report {
namespace {

using fusion::CalibratedProperty;
using vehicle::CalibrationReport;
using web::figure;

// The share of a property's uncertainty that the drive has left.
double left(const CalibratedProperty& p) {
  return p.sigma_at_start > 0.0 ? p.sigma / p.sigma_at_start : 1.0;
}

constexpr double shown_below = 0.9;  // of it left: what the drive has hardly shown has no picture

// Indices of the properties, the best observed first.
std::vector<std::size_t> ranked(const fusion::SelfCalibrations& properties) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].sigma_at_start > 0.0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return left(properties[a]) < left(properties[b]);
  });
  return order;
}

std::string table_of(const fusion::SelfCalibrations& properties,
                     const std::vector<std::size_t>& order) {
  std::vector<web::Row> rows;
  for (const std::size_t i : order) {
    const CalibratedProperty& p = properties[i];
    rows.push_back({std::string(p.name), figure(p.value, 3), figure(p.sigma, 3),
                    figure(p.sigma_at_start, 3), std::string(p.unit), figure(100.0 * left(p), 0),
                    p.observed() ? "yes" : "not yet"});
  }
  return web::table(
      {"property", "value", "sigma", "sigma at the start", "unit", "of it left, %", "observed"},
      rows);
}

web::Plot convergence(const Scene& scene, std::size_t property) {
  const auto& moments = scene.report.pass.calibrations;
  const CalibratedProperty& last = moments.back().properties[property];
  web::Plot plot{std::string(last.name), "s", std::string(last.unit), {{"estimated", {}, {}}}};
  plot.over_time = true;
  plot.in_readout = false;
  web::Band band{"3 sigma", {}, {}, {}};
  for (const CalibrationReport& moment : moments) {
    const CalibratedProperty& p = moment.properties[property];
    if (p.sigma <= 0.0) continue;  // the filter had not started
    const double second = scene.second(moment.stamp);
    plot.lines[0].add(second, p.value);
    band.x.push_back(second);
    band.low.push_back(p.value - sigmas * p.sigma);
    band.high.push_back(p.value + sigmas * p.sigma);
  }
  plot.bands = {std::move(band)};
  return plot;
}

}  // namespace

void add_calibration(web::Page& page, const Scene& scene) {
  const auto& moments = scene.report.pass.calibrations;
  if (moments.empty()) return;
  const fusion::SelfCalibrations& last = moments.back().properties;
  const std::vector<std::size_t> order = ranked(last);
  if (order.empty()) return;
  page.add(web::heading("Calibration on the drive") +
           web::paragraph("What the filter has found out about the car and its sensors, the best "
                          "observed first. A property is observed once the drive has halved its "
                          "standard deviation; before that its value is what was given.") +
           table_of(last, order));
  std::vector<web::Plot> plots;
  for (const std::size_t i : order)
    if (left(last[i]) < shown_below) plots.push_back(convergence(scene, i));
  page.add(plots);
  page.add(web::folded("The car as it was described", vehicle_tool::drawing(scene.report.config)));
}

}  // namespace maploop::report
