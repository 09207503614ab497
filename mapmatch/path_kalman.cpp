#include "mapmatch/path_kalman.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double chord = 6.0;      // m before and after, chord of the path's azimuth
constexpr double bend_step = 3.0;  // m before and after, where its change is measured
constexpr double edge_cost = 0.3;  // log weight per metre driven past a dead end
constexpr double lost = 9.0;  // sigmas squared along the path, beyond which it counts as misfit

double squared(double x) {
  return x * x;
}

}  // namespace

void PathKalman::begin(PathHypothesis& h, const LinkPoint& point, const PathEvidence& e) const {
  const Eigen::Matrix2d slow = slow_covariance(e);
  const Eigen::Matrix2d S = slow + fast_covariance(e);
  const Eigen::Matrix2d inverse = S.inverse();
  // The fix gives the position on the link and the distance beside it; the offset is not known
  // separately.
  const Eigen::Vector2d beside = e.place - point.position;
  const Eigen::Vector2d u = h.link.forward ? point.direction : Eigen::Vector2d(-point.direction);
  h.covariance(0, 0) = u.dot(S * u);
  h.covariance.block<2, 2>(1, 1) = slow;
  h.offset = slow * inverse * beside;
  h.covariance.block<1, 2>(0, 1) = -u.transpose() * slow;
  h.covariance.block<2, 1>(1, 0) = -slow * u;
  h.offset_misfit = beside.dot(inverse * beside);
  h.log_weight -= 0.5 * h.offset_misfit;
  if (!std::isfinite(e.motion.azimuth)) return;
  const double variance = squared(parameters_->azimuth_noise) + squared(e.motion.azimuth_sigma);
  h.azimuth_misfit = std::min(max_azimuth_misfit, squared(azimuth_error(h, e)) / variance);
  h.log_weight -= 0.5 * h.azimuth_misfit;
}

Eigen::Matrix2d PathKalman::slow_covariance(const PathEvidence& e) const {
  // (2) of METHOD.md
  return squared(parameters_->map_sigma) * Eigen::Matrix2d::Identity() +
         (1.0 - e.motion.white_share) * e.covariance;
}

Eigen::Matrix2d PathKalman::fast_covariance(const PathEvidence& e) const {
  // The fast part of the road's error is one new error per second of driving, whatever the rate of
  // fixes.
  const double repeats = std::max(1.0, 1.0 / std::max(e.motion.interval, 0.01)) *
                         (e.motion.speed < standing ? 10.0 : 1.0);
  // (3) of METHOD.md
  return squared(parameters_->road_noise) * repeats * Eigen::Matrix2d::Identity() +
         e.motion.white_share * e.covariance;
}

void PathKalman::predict(PathHypothesis& h, const PathEvidence& e) const {
  const double keep = std::exp(-e.motion.interval / parameters_->correlation_time);
  h.s += e.motion.distance;  // (4) of METHOD.md
  const double gained = parameters_->trust * e.motion.distance / parameters_->trust_distance;
  h.trust = std::min(parameters_->trust, h.trust + gained);
  h.offset *= keep;
  h.covariance.block<1, 2>(0, 1) *= keep;
  h.covariance.block<2, 1>(1, 0) *= keep;
  h.covariance.block<2, 2>(1, 1) *= keep * keep;
  h.covariance.block<2, 2>(1, 1) += (1.0 - keep * keep) * slow_covariance(e);
  h.covariance(0, 0) += squared(e.motion.speed_sigma * e.motion.interval) +
                        squared(parameters_->distance_scale * e.motion.distance) + corner_cut(e);
}

// Vehicles cut corners, so a turn is shorter than the path along the roads.
double PathKalman::corner_cut(const PathEvidence& e) const {
  const double turn = std::isfinite(e.motion.turn) ? e.motion.turn : 0.0;
  return squared(parameters_->corner) * turn * std::min(e.motion.interval, 1.0);
}

// The map's part of the offset differs from road to road.
void PathKalman::enter_link(PathHypothesis& h, const PathEvidence& e) const {
  const Eigen::Matrix2d slow = slow_covariance(e);
  const double map = squared(parameters_->map_sigma);
  // (5) of METHOD.md
  const double keep = 1.0 - (1.0 - parameters_->link_memory) * map / (0.5 * slow.trace());
  h.offset *= keep;
  h.covariance.block<1, 2>(0, 1) *= keep;
  h.covariance.block<2, 1>(1, 0) *= keep;
  h.covariance.block<2, 2>(1, 1) *= keep * keep;
  h.covariance.block<2, 2>(1, 1) += (1.0 - keep * keep) * slow;
}

// Returns the azimuth of the path about a place, averaged because a vehicle turns more slowly than
// the path bends.
double PathKalman::azimuth_at(const PathHypothesis& h, double s) const {
  const Eigen::Vector2d along = place_on_path(*network_, h, s + chord).point.position -
                                place_on_path(*network_, h, s - chord).point.position;
  // Where the path turns back, the chord gives no direction.
  if (along.squaredNorm() < 1.0) return place_on_path(*network_, h, s).point.azimuth();
  return std::atan2(along.x(), along.y());
}

double PathKalman::azimuth_error(const PathHypothesis& h, const PathEvidence& e) const {
  return wrap_angle(e.motion.azimuth - azimuth_at(h, h.s));
}

// Returns the place on the path that fits best between prediction and fix, since a bent path can be
// linearized only about this place.
PathKalman::PlaceOnPath PathKalman::best_place(const PathHypothesis& h, const PathEvidence& e,
                                               const Eigen::Matrix2d& R) const {
  const Eigen::Vector2d target = e.place - h.offset;
  const double fix_variance = 0.5 * (R + h.covariance.block<2, 2>(1, 1)).trace();
  const double path_variance = std::max(h.covariance(0, 0), 0.01);
  const double window = 3.0 * std::sqrt(path_variance) + 3.0;
  double best_cost = 1e300;
  PlaceOnPath best{{}, h.s};
  double s = h.s - window;
  for (int pieces = 0; pieces < 24 && s < h.s + window; ++pieces) {
    const PathPoint begin = place_on_path(*network_, h, s + 1e-6);
    // This piece ends with the segment.
    const Link& link = network_->link(begin.link.link);
    const Vertex& a = network_->vertex(begin.point.vertex);
    const Vertex& b = network_->vertex(begin.point.vertex + 1);
    double left = (begin.link.forward ? b.along : link.length - a.along) - begin.s;
    if (left <= 1e-6) left = 2.0 * window;  // on the straight continuation past an end
    const double end = std::min(s + left, h.s + window);
    const Eigen::Vector2d& u = begin.point.direction;
    const double projected = s + u.dot(target - begin.point.position);
    const double mean = (projected / fix_variance + h.s / path_variance) /
                        (1.0 / fix_variance + 1.0 / path_variance);
    const double at = std::clamp(mean, s, end);
    const Eigen::Vector2d place = begin.point.position + u * (at - s);
    const double cost =
        squared(at - h.s) / path_variance + (target - place).squaredNorm() / fix_variance;
    if (cost < best_cost) {
      best_cost = cost;
      best.s = at;
      best.on = begin;
      best.on.point.position = place;
    }
    s = end + 1e-6;
  }
  return best;
}

void PathKalman::correct(PathHypothesis& h, const PathEvidence& e) const {
  const Eigen::Matrix2d R = fast_covariance(e);
  const auto [best, best_s] = best_place(h, e, R);
  const Eigen::Vector2d& u = best.point.direction;
  Eigen::Matrix<double, 2, 3> H;
  H.col(0) = u;
  H.rightCols<2>().setIdentity();
  // (6) of METHOD.md
  const Eigen::Vector2d predicted = best.point.position + u * (h.s - best_s) + h.offset;
  const Eigen::Vector2d innovation = e.place - predicted;
  Eigen::Matrix2d S = H * h.covariance * H.transpose() + R;
  double nis = innovation.dot(S.inverse() * innovation);
  if (nis > parameters_->gate) {  // counts as a fix with a correspondingly larger error
    S *= nis / parameters_->gate;
    nis = parameters_->gate;
  }
  if (e.motion.speed >= standing) {
    h.log_weight -=
        parameters_->position_weight * 0.5 * (nis + std::log(std::max(1e-12, S.determinant())));
  }
  const Eigen::Matrix<double, 3, 2> K = h.covariance * H.transpose() * S.inverse();
  const Eigen::Vector3d step = K * innovation;
  h.s += step.x();
  h.offset += step.tail<2>();
  const Eigen::Matrix3d updated = h.covariance - K * H * h.covariance;
  h.covariance = 0.5 * (updated + updated.transpose());
  h.azimuth_misfit = 0.0;
  judge_offset(h, best, e);
  const double beyond = h.s - network_->link(h.link.link).length;
  if (!h.has_next && beyond > 0.0) h.log_weight -= edge_cost * e.motion.distance;
  if (std::isfinite(e.motion.azimuth) && e.motion.speed > parameters_->min_speed)
    correct_by_azimuth(h, e);
}

// Computes the misfit of the corrected hypothesis relative to its road and lowers its weight.
void PathKalman::judge_offset(PathHypothesis& h, const PathPoint& best,
                              const PathEvidence& e) const {
  const Eigen::Vector2d& u = best.point.direction;
  // The misfit is the distance from the road relative to the slow and fast errors.
  const Eigen::Vector2d n(u.y(), -u.x());
  const Eigen::Matrix2d slow = slow_covariance(e);
  h.offset_misfit = squared(n.dot(h.offset)) / n.dot(slow * n);
  const Eigen::Vector2d beside = e.place - best.point.position;
  const Eigen::Matrix2d all = slow + e.motion.white_share * e.covariance;
  h.offset_misfit = std::max(h.offset_misfit, squared(n.dot(beside)) / n.dot(all * n));
  // A hypothesis far ahead of or behind the fix has lost the vehicle.
  const double along = squared(u.dot(beside)) / (u.dot(all * u) + h.covariance(0, 0));
  if (along > lost) h.offset_misfit += along;
  if (!network_->allowed(best.link) && !network_->doubted(best.link.link))
    h.offset_misfit += parameters_->wrong_way_misfit;
  if (e.motion.speed < standing) return;
  // An offset that is attributed to the map's error costs weight as long as it lasts.
  h.log_weight -=
      parameters_->misfit_rate * 0.5 * h.offset_misfit * std::min(e.motion.interval, 1.0);
}

// The azimuth determines the position in a bend or a turn, and tests whether the path bends like
// the vehicle's.
void PathKalman::correct_by_azimuth(PathHypothesis& h, const PathEvidence& e) const {
  const double error = azimuth_error(h, e);
  const double bend = wrap_angle(azimuth_at(h, h.s + bend_step) - azimuth_at(h, h.s - bend_step)) /
                      (2.0 * bend_step);
  const double variance = squared(parameters_->azimuth_noise) + squared(e.motion.azimuth_sigma);
  const double placed =
      squared(bend) * h.covariance(0, 0);  // variance due to the position on the path
  h.azimuth_misfit = std::min(max_azimuth_misfit, squared(error) / (variance + placed));
  // Azimuth errors change slowly, so the weight is per second, whatever the rate of fixes.
  const double weight = parameters_->azimuth_weight * std::min(e.motion.interval, 1.0);
  if (weight <= 0.0) return;
  const double R = variance / weight;  // (7) of METHOD.md
  const double nis = std::min(squared(error) / (placed + R), weight * max_azimuth_misfit);
  h.log_weight -= 0.5 * nis;
  const double S = std::max(placed + R, squared(error) / max_azimuth_misfit);
  const Eigen::Vector3d K = h.covariance.col(0) * bend / S;
  h.s += K.x() * error;
  h.offset += K.tail<2>() * error;
  const Eigen::Matrix3d updated = h.covariance - K * bend * h.covariance.row(0);
  h.covariance = 0.5 * (updated + updated.transpose());
}

}  // namespace maploop::mapmatch
