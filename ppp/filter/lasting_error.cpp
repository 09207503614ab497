#include "ppp/filter/lasting_error.h"

#include <Eigen/Dense>
#include <algorithm>

namespace maploop::ppp {
namespace {

using S = FilterState;

}  // namespace

// An ionosphere without a model lengthens all ranges at once: it moves the position along one line.
std::optional<LastingError> lasting_error_of(const std::vector<Tracked>& tracked,
                                             const RangeModel& model, const FilterState& state,
                                             const PppParameters& parameters) {
  constexpr double least_variance = 1e-4;  // m^2, a floor for products accurate to millimetres
  const Eigen::Matrix3d& R = model.R_enu_ecef();
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d unmodelled = Eigen::Vector4d::Zero();
  int count = 0;
  for (const Tracked& t : tracked) {
    if (!t.code_good) continue;
    const Eigen::Vector3d u = R * t.predicted.to_satellite;
    const Eigen::Vector4d h(-u.x(), -u.y(), -u.z(), 1.0);
    const double weight = 1.0 / std::max(least_variance, lasting_variance(t.predicted));
    normal += weight * h * h.transpose();
    if (t.predicted.ionosphere.value == 0.0)
      unmodelled += weight * t.predicted.ionosphere.sigma * h;
    ++count;
  }
  if (count <= position_unknowns) return {};
  const Eigen::Matrix4d covariance = normal.inverse();
  const Eigen::Vector2d variance = covariance.diagonal().head<2>();
  if (!variance.allFinite() || variance.minCoeff() <= 0.0) return {};
  const Eigen::Matrix3d all = R * state.P().block<3, 3>(S::position, S::position) * R.transpose();
  return LastingError{variance.cwiseMin(parameters.map_lasting_share * all.diagonal().head<2>()),
                      R.transpose() * (covariance * unmodelled).head<3>()};
}

// The rows count that error as noise, so the covariance without a map already contains its full
// size.
void add_lasting_error(const FilterState& state, const Eigen::Matrix3d& R, PppSolution& solution) {
  const auto P = state.P();
  const Eigen::Matrix3d own = R * solution.covariance * R.transpose();
  const Eigen::Matrix2d lasting = P.block<2, 2>(S::lasting_error, S::lasting_error);
  const Eigen::Matrix<double, 3, 2> crossed = R * P.block<3, 2>(S::position, S::lasting_error);
  Eigen::Matrix3d sum = own;
  sum.leftCols<2>() += crossed;
  sum.topRows<2>() += crossed.transpose();
  sum.topLeftCorner<2, 2>() += lasting;
  // The scale would turn the sum of two uncorrelated covariances back into the first.
  const Eigen::Matrix2d once = own.topLeftCorner<2, 2>(), twice = once + lasting;
  Eigen::Matrix3d shrink = Eigen::Matrix3d::Identity();
  // (23) of METHOD.md
  shrink.topLeftCorner<2, 2>() =
      Eigen::Matrix2d(once.llt().matrixL()) * Eigen::Matrix2d(twice.llt().matrixL()).inverse();
  solution.position += R.topRows<2>().transpose() * state.x().segment<2>(S::lasting_error);
  solution.covariance = R.transpose() * shrink * sum * shrink.transpose() * R;
}

}  // namespace maploop::ppp
