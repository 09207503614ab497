#include "tools/ppp/score.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "ppp/models/geodesy.h"
#include "tools/evaluate/evaluation.h"

namespace maploop::gnss {

using namespace maploop::ppp;

namespace {

constexpr double wrong = 0.1;  // m: an epoch with integers that is this far off had wrong ones

}  // namespace

void Score::add(const PppSolution& solution) {
  const auto truth = truth_.at(solution.time);
  if (!truth) return;
  with_truth_.push_back(solution.time);
  if (!solution.has_position()) return;
  const Eigen::Matrix3d R = rotation_enu_ecef(geodetic_from_ecef(*truth));
  const Eigen::Vector3d e = solution.position - *truth;
  const Eigen::Matrix3d P = R * solution.covariance * R.transpose();
  const Eigen::Vector3d enu = R * e, velocity = R * solution.velocity;
  const TravelAxes axes = travel_axes(velocity);
  const ProtectionLevels levels = protection_levels(P, velocity, factor_);
  errors_.push_back({solution.time,
                     enu,
                     P.diagonal().cwiseMax(0.0).cwiseSqrt(),
                     e.dot(solution.covariance.ldlt().solve(e)),
                     solution.status == PppStatus::fixed,
                     axes.known,
                     {axes.along.dot(enu.head<2>()), axes.across.dot(enu.head<2>()), enu.z()},
                     {levels.along, levels.across, levels.up}});
}

std::size_t Score::misleading() const {
  std::size_t count = 0;
  for (const ErrorAt& e : errors_) {
    for (int i = 0; i < 3; ++i) count += std::abs(e.travel[i]) > e.protection[i];
  }
  return count;
}

Accuracy Score::accuracy(std::optional<GpsTime> from) const {
  Accuracy a;
  std::vector<double> horizontal;
  double across = 0.0;
  std::size_t moving = 0;
  for (const GpsTime t : with_truth_) a.with_truth += !from || t >= *from;
  for (const ErrorAt& e : errors_) {
    if (from && e.time < *from) continue;
    horizontal.push_back(e.enu.head<2>().norm());
    a.mean_enu += e.enu;
    a.up_rmse += e.enu.z() * e.enu.z();
    a.nees += e.nees;
    if (e.moves) {
      across += e.travel.y() * e.travel.y();
      ++moving;
    }
    a.three_d_last = e.enu.norm();
    a.fixed += e.fixed;
    a.wrongly_fixed += e.fixed && a.three_d_last > wrong;
  }
  a.solved = horizontal.size();
  if (a.solved == 0) return a;
  const auto n = static_cast<double>(a.solved);
  a.mean_enu /= n;
  if (moving > 0) a.across_rmse = std::sqrt(across / static_cast<double>(moving));
  a.nees /= n;
  a.up_rmse = std::sqrt(a.up_rmse / n);
  double sum = 0.0;
  for (const double h : horizontal) sum += h * h;
  a.horizontal_rmse = std::sqrt(sum / n);
  a.horizontal_rmse_without_mean =
      std::sqrt(std::max(0.0, sum / n - a.mean_enu.head<2>().squaredNorm()));
  std::sort(horizontal.begin(), horizontal.end());
  a.horizontal_95 = evaluation::quantile(horizontal, 0.95);
  return a;
}

std::optional<double> Score::time_to_stay_below(double limit) const {
  if (errors_.empty() || errors_.back().enu.norm() > limit) return {};
  GpsTime since = with_truth_.front();
  for (const ErrorAt& e : errors_) {
    if (e.enu.norm() > limit) since = e.time;
  }
  return to_seconds(since - with_truth_.front());
}

std::string to_text(const Accuracy& a) {
  if (a.with_truth == 0) return "no epoch at a time of the truth";
  if (a.solved == 0) return "none of " + std::to_string(a.with_truth) + " epochs has a position";
  return fmt::format(
      "{} of {} epochs ({:.1f} %): horizontal RMSE {:.3f} m, 95 % {:.3f} m; across the way {:.3f} "
      "m; "
      "up RMSE {:.3f} m; mean east {:.3f}, north {:.3f}, up {:.3f} m; horizontal about its mean "
      "{:.3f} m; last 3-D {:.3f} m; NEES {:.2f} of 3; {} epochs with integer ambiguities, {} of "
      "them more "
      "than 0.1 m off",
      a.solved, a.with_truth, 100.0 * a.coverage(), a.horizontal_rmse, a.horizontal_95,
      a.across_rmse, a.up_rmse, a.mean_enu.x(), a.mean_enu.y(), a.mean_enu.z(),
      a.horizontal_rmse_without_mean, a.three_d_last, a.nees, a.fixed, a.wrongly_fixed);
}

}  // namespace maploop::gnss
