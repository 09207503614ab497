#include "tools/ppp/page_data.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "msgs/frames.h"
#include "msgs/median.h"
#include "ppp/models/geodesy.h"
#include "tools/web/page.h"

namespace maploop::gnss {

using namespace maploop::ppp;
using nlohmann::json;

namespace {

using Positions = std::vector<std::optional<Eigen::Vector3d>>;

// The usual time from one epoch to the next.
double interval_of(const Solutions& solutions) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < solutions.size(); ++i)
    steps.push_back(to_seconds(solutions[i].time - solutions[i - 1].time));
  return steps.empty() ? 1.0 : median(steps);
}

// Whole tenths of a millimetre, as metres.
json rounded(double metres) {
  return std::isfinite(metres) ? json(std::round(1e4 * metres) * 1e-4) : json();
}

// A multiple of a unit; null where it is not known.
json in_units(double value, double unit) {
  return std::isfinite(value) ? json(std::lround(value / unit)) : json();
}

Eigen::Vector3d sigma_enu(const PppSolution& s) {
  const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(s.position));
  return (R * s.covariance * R.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

json track(const std::string& name, const Positions& positions, const Eigen::Vector3d& origin) {
  json j{{"name", name}, {"x", json::array()}, {"y", json::array()}, {"z", json::array()}};
  constexpr std::array axes{"x", "y", "z"};
  for (const auto& p : positions) {
    for (int k = 0; k < 3; ++k)
      j[axes[static_cast<std::size_t>(k)]].push_back(p ? rounded((*p - origin)[k]) : json());
  }
  return j;
}

// Returns 0 if a satellite was used with an integer ambiguity, 1 if all of it was used, 2 if a part
// was used, and otherwise the reason from 3 on.
std::size_t state_of(const SatelliteReport& r) {
  if (r.code_used && r.phase_used) return r.integer ? 0 : 1;
  if (r.code_used || r.phase_used) return 2;
  return 2 + std::max<std::size_t>(1, static_cast<std::size_t>(r.refused));
}

json states() {
  json list{"used, integer ambiguity", "used", "used in part"};
  for (std::size_t i = 1; i < count_of<PppRefusal>; ++i)
    list.push_back(to_string(static_cast<PppRefusal>(i)));
  return list;
}

// One satellite over a run.
struct History {
  json at = json::array(), azimuth = json::array(), elevation = json::array();
  json cn0 = json::array(), code = json::array(), phase = json::array();
  json ionosphere = json::array();
  json spans = json::array(), slips = json::array();
  double last = -1.0;  // time of its last span's end
  std::size_t state = 0;

  void add_values(std::size_t epoch, const SatelliteReport& r) {
    at.push_back(epoch);
    azimuth.push_back(in_units(degrees(r.azimuth), 0.1));
    elevation.push_back(in_units(degrees(r.elevation), 0.1));
    cn0.push_back(in_units(r.cn0 > 0.0 ? r.cn0 : unknown, 0.1));
    code.push_back(in_units(r.code_used ? r.code_residual : unknown, 1e-3));
    phase.push_back(in_units(r.phase_used ? r.phase_residual : unknown, 1e-3));
    ionosphere.push_back(in_units(r.ionosphere != 0.0 ? r.ionosphere : unknown, 1e-3));
  }

  // `before`: the time of the epoch before.
  void add_state(double before, double now, const SatelliteReport& r) {
    const std::size_t next = state_of(r);
    if (spans.empty() || last != before || state != next) {
      const bool follows = !spans.empty() && last == before;
      spans.push_back({follows ? before : now, now, next});
    }
    spans.back()[1] = now;
    last = now;
    state = next;
    if (r.slip != PppSlip::none) slips.push_back({now, to_string(r.slip)});
  }

  json to_json(Satellite satellite) && {
    return {{"name", to_string(satellite)},  {"at", std::move(at)},
            {"azimuth", std::move(azimuth)}, {"elevation", std::move(elevation)},
            {"cn0", std::move(cn0)},         {"code", std::move(code)},
            {"phase", std::move(phase)},     {"ionosphere", std::move(ionosphere)},
            {"spans", std::move(spans)},     {"slips", std::move(slips)}};
  }
};

}  // namespace

std::vector<EpochRow> epoch_rows(const Solutions& solutions) {
  std::vector<EpochRow> rows;
  const double interval = interval_of(solutions);
  for (const PppSolution& s : solutions) {
    const double second = to_seconds(s.time - solutions.front().time);
    if (!rows.empty() && second - rows.back().second > 1.5 * interval)
      rows.push_back({0.5 * (rows.back().second + second)});
    rows.push_back({second, &s});
  }
  return rows;
}

Dilutions dilutions(const PppSolution& solution) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  for (const SatelliteReport& r : solution.satellites) {
    if (!r.code_used && !r.phase_used) continue;
    const double level = std::cos(r.elevation);
    const Eigen::Vector4d row(level * std::sin(r.azimuth), level * std::cos(r.azimuth),
                              std::sin(r.elevation), 1.0);
    normal += row * row.transpose();
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> decomposed(normal);
  if (!decomposed.isInvertible()) return {};
  const Eigen::Vector4d variance = decomposed.inverse().diagonal();
  const double horizontal = variance[0] + variance[1];
  return {std::sqrt(horizontal + variance[2]), std::sqrt(horizontal), std::sqrt(variance[2])};
}

json positions_json(const std::vector<EpochRow>& rows, const PppResult& result) {
  std::vector<std::pair<std::string, std::function<std::optional<Eigen::Vector3d>(GpsTime)>>> all;
  if (result.truth) all.emplace_back("truth", [&](GpsTime t) { return result.truth->at(t); });
  for (const OtherSolution& other : result.others)
    all.emplace_back(other.name, [&](GpsTime t) { return other.at(t); });

  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::array<std::vector<double>, 3> off;  // which epochs are drawn is by these
  for (const EpochRow& row : rows) {
    if (row.solved() && origin.isZero()) origin = row.solution->position;
    const auto from =
        row.solved() && result.truth ? result.truth->at(row.solution->time) : std::optional(origin);
    for (int k = 0; k < 3; ++k)
      off[static_cast<std::size_t>(k)].push_back(
          row.solved() ? (row.solution->position - from.value_or(origin))[k] : unknown);
  }
  json time = json::array();
  std::array<json, 3> sigma{json::array(), json::array(), json::array()};
  std::string status;
  Positions own;
  std::vector<Positions> others(all.size());
  for (const std::size_t i : web::thinned(rows.size(), {&off[0], &off[1], &off[2]})) {
    const EpochRow& row = rows[i];
    time.push_back(rounded(row.second));
    status += static_cast<char>('0' + (row.solved() ? static_cast<int>(row.solution->status) : 0));
    own.push_back(row.solved() ? std::optional(row.solution->position) : std::nullopt);
    for (std::size_t k = 0; k < all.size(); ++k)
      others[k].push_back(row.solution ? all[k].second(row.solution->time) : std::nullopt);
    for (int k = 0; k < 3; ++k)
      sigma[static_cast<std::size_t>(k)].push_back(
          row.solved() ? rounded(sigma_enu(*row.solution)[k]) : json());
  }
  json tracks{track("this solution", own, origin)};
  for (std::size_t k = 0; k < all.size(); ++k)
    tracks.push_back(track(all[k].first, others[k], origin));
  return {{"time", time},
          {"status", status},
          {"origin", {origin.x(), origin.y(), origin.z()}},
          {"sigma", sigma},
          {"tracks", tracks}};
}

json satellites_json(const std::vector<EpochRow>& rows) {
  constexpr std::size_t most = 1500;  // epochs with values; states and slips are of all
  const std::size_t step = 1 + rows.size() / most;
  std::map<Satellite, History> histories;
  json time = json::array();
  double before = -1.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EpochRow& row = rows[i];
    if (row.solution == nullptr) {
      before = -1.0;
      continue;
    }
    const double now = std::round(1e3 * row.second) * 1e-3;
    for (const SatelliteReport& r : row.solution->satellites) {
      History& history = histories[r.satellite];
      history.add_state(before, now, r);
      if (i % step == 0) history.add_values(time.size(), r);
    }
    if (i % step == 0) time.push_back(now);
    before = now;
  }
  json list = json::array();
  for (auto& [satellite, history] : histories)
    list.push_back(std::move(history).to_json(satellite));
  return {{"time", time}, {"states", states()}, {"list", list}};
}

}  // namespace maploop::gnss
