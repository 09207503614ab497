#include "tools/experiment/ppp_map_run.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "mapmatch/osm_reader.h"
#include "ppp/models/geodesy.h"
#include "ppp/protection.h"
#include "tools/evaluate/text_file.h"

namespace maploop::experiments {
namespace {

using ppp::PppSolution;

std::map<int, std::optional<std::int64_t>> read_driven(const std::filesystem::path& file) {
  std::istringstream lines(evaluation::read_text(file));
  std::string line;
  if (!std::getline(lines, line) || !line.starts_with("gps_tow,on_map,way_id"))
    throw std::runtime_error(file.string() + ":1: labels begin with gps_tow,on_map,way_id");
  std::map<int, std::optional<std::int64_t>> driven;
  for (int number = 2; std::getline(lines, line); ++number) {
    int second = 0, on = 0;
    long long way = 0;
    const int read = std::sscanf(line.c_str(), "%d,%d,%lld", &second, &on, &way);
    if (read < 2 || (on != 0 && read < 3))
      throw std::runtime_error(file.string() + ":" + std::to_string(number) +
                               ": not gps_tow,on_map,way_id");
    driven[second] = on != 0 ? std::optional<std::int64_t>(way) : std::nullopt;
  }
  return driven;
}

// The errors of a solution across the truth's way and horizontally.
struct Errors {
  double across = 0.0, horizontal = 0.0, sigma = 0.0;
};

Errors errors_of(const PppSolution& s, const Eigen::Vector3d& truth, const Eigen::Matrix3d& R,
                 const Eigen::Vector2d& across) {
  const Eigen::Vector2d e = (R * (s.position - truth)).head<2>();
  const Eigen::Matrix2d P = (R * s.covariance * R.transpose()).topLeftCorner<2, 2>();
  return {across.dot(e), e.norm(), std::sqrt(across.dot(P * across))};
}

}  // namespace

PppDrive read_ppp_drive(const PppDriveFiles& files) {
  PppDrive drive;
  drive.name = files.name;
  drive.group = files.group;
  for (const std::filesystem::path& file : ppp::files_in(files.folder)) {
    if (ppp::kind_of_file(file) != ppp::FileKind::unknown) ppp::read_into(file, drive.files);
  }
  for (const auto& product : files.products) ppp::read_products(product, drive.files);
  if (drive.files.observations.size() != 1 || drive.files.observations[0].epochs.empty())
    throw std::runtime_error(files.folder.string() +
                             ": the folder must hold the observations of one receiver");
  drive.truth = std::make_unique<gnss::Truth>(files.truth.string(),
                                              drive.files.observations[0].epochs[0].time);
  drive.map = mapmatch::read_osm(files.map);
  if (!files.labels.empty()) drive.driven = read_driven(files.labels);
  return drive;
}

std::vector<PppMoment> run_case(const PppSetting& setting, const PppCase& c) {
  const auto& epochs = setting.setup->observations().epochs;
  ppp::MapAidedFilter filter = setting.setup->make_map_aided_filter();
  gnss::MapLoop loop({setting.network, setting.rules, setting.match, setting.feedback, true});
  const ppp::GpsTime begin = epochs.front().time + from_seconds(c.start);
  std::vector<PppMoment> moments;
  for (const ppp::Epoch& epoch : epochs) {
    const double time = to_seconds(epoch.time - begin);
    if (time < 0.0) continue;
    if (time >= c.length) break;
    const bool blocked = time >= c.blocked_from && time < c.blocked_from + c.blocked_for;
    if (blocked) continue;  // a receiver without satellites writes no epoch
    filter.process(epoch);
    PppMoment m;
    m.time = time;
    const PppSolution aided = filter.solution();
    const PppSolution& free = filter.map_free();
    const gnss::MapStep step = loop.close(filter);
    const auto truth = setting.truth->at(epoch.time);
    const auto before = setting.truth->at(epoch.time - from_seconds(1.0));
    if (!truth || free.status == PppStatus::none || aided.status == PppStatus::none) continue;
    const Eigen::Matrix3d R = ppp::rotation_enu_ecef(ppp::geodetic_from_ecef(*truth));
    Eigen::Vector2d across(1.0, 0.0);
    if (before) {
      const ppp::TravelAxes axes = ppp::travel_axes(R * (*truth - *before));
      m.moves = axes.known;
      if (axes.known) across = axes.across;
    }
    const auto second = static_cast<int>(std::lround(ppp::seconds_of_week(epoch.time)));
    if (const auto label = setting.driven->find(second); label != setting.driven->end())
      m.on_map = label->second.has_value();
    const Errors f = errors_of(free, *truth, R, across), a = errors_of(aided, *truth, R, across);
    m.across_free = f.across;
    m.across_aided = a.across;
    m.horizontal_free = f.horizontal;
    m.horizontal_aided = a.horizontal;
    m.sigma_free = f.sigma;
    const Eigen::Vector2d apart = (R * (aided.position - free.position)).head<2>();
    const Eigen::Matrix2d P = (R * free.covariance * R.transpose()).topLeftCorner<2, 2>();
    m.apart = std::sqrt(apart.dot(P.inverse() * apart));
    m.used = step.use == ppp::MapUse::used;
    m.paused = filter.paused();
    m.restorations = filter.restorations();
    moments.push_back(m);
  }
  return moments;
}

}  // namespace maploop::experiments
