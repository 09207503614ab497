#include "estimators/fusion/guarded_filter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimators/fusion/parameter_table.h"
#include "msgs/archive.h"
#include "msgs/parameter_archive.h"

namespace maploop::fusion {

Outcome GuardedFilter::add(const MapFeedback& feedback) {
  const Time t = feedback.stamp;
  if (!copies_[0].filter) {
    if (!aided_.initialized()) return refused(Reason::before_start);
    for (Copy& copy : copies_) copy_to(copy, t);
    copies_[0].born = t - from_seconds(0.5 * parameters_.lifetime);
  }
  Outcome outcome = refused(Reason::map_not_trusted);
  if (!feedback.position && !feedback.azimuth) {
    outcome = refused(Reason::nothing_fed_back);
  } else if (t >= paused_until_) {
    outcome = aided_.add(feedback);
  }

  const auto state = aided_.state_at(t);
  if (!state) return outcome;
  const double interval = last_ == Time{} ? 0.0 : to_seconds(t - last_);
  last_ = t;
  for (Copy& copy : copies_) copy.way += std::abs(state->forward_speed) * interval;
  const double far =
      std::max(distance_to(copies_[0], *state, t), distance_to(copies_[1], *state, t));
  if (far <= parameters_.difference_gate) {
    apart_ = false;
  } else if (!apart_) {
    apart_ = true;
    apart_since_ = t;
  } else if (t - apart_since_ >= from_seconds(parameters_.patience)) {
    restore(t);
    return outcome;
  }
  // A copy whose azimuth is lost (a gap of the gyro) cannot reveal a wrong road, so it is replaced.
  for (Copy& copy : copies_) {
    const auto free = copy.filter->state_at(t);
    if (!lost(*state) && free && lost(*free)) copy_to(copy, t);
  }
  const Duration age = t - copies_[0].born, lifetime = from_seconds(parameters_.lifetime);
  if (age >= 2 * lifetime || (age >= lifetime && far <= parameters_.trusted)) {
    std::swap(copies_[0], copies_[1]);
    copy_to(copies_[1], t);
  }
  return outcome;
}

// Returns whether the azimuth is lost: beyond the limit the position error is not linear in the
// azimuth error, so the covariance is not meaningful.
bool GuardedFilter::lost(const NavState& state) const {
  return state.covariance(6, 6) > parameters_.lost_azimuth * parameters_.lost_azimuth;
}

std::optional<FusedState> GuardedFilter::without_map_at(Time t) const {
  if (!copies_[0].filter) return std::nullopt;
  auto free = copies_[0].filter->state_at(t);
  if (free && lost(*free)) free.reset();
  return free;
}

void GuardedFilter::copy_to(Copy& copy, Time t) {
  copy.filter = aided_;
  copy.born = t;
  copy.way = 0.0;
}

// The copies forget the last place too.
void GuardedFilter::follow(Time t) {
  for (Copy& copy : copies_)
    if (copy.filter) copy_to(copy, t);
}

double GuardedFilter::distance_to(const Copy& copy, const NavState& aided, Time t) const {
  const auto free = copy.filter->state_at(t);
  if (!free || lost(*free)) return 0.0;
  const Eigen::Vector2d apart = (aided.position_enu - free->position_enu).head<2>();
  // (27) of METHOD.md
  Eigen::Matrix2d D =
      (parameters_.overconfidence * free->covariance - aided.covariance).topLeftCorner<2, 2>();
  // Rounding and linearization may make D indefinite.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(D);
  const double share = parameters_.model_share * copy.way;
  const double least = parameters_.model_sigma * parameters_.model_sigma + share * share;
  const Eigen::Vector2d values = eigen.eigenvalues().cwiseMax(0.0).array() + least;
  const Eigen::Vector2d along = eigen.eigenvectors().transpose() * apart;
  return (along.array().square() / values.array()).sum();  // (28) of METHOD.md
}

void GuardedFilter::restore(Time t) {
  aided_.take_over(*copies_[0].filter);
  copies_[0].born = t - from_seconds(0.5 * parameters_.lifetime);
  copy_to(copies_[1], t);
  apart_ = false;
  paused_until_ = t + from_seconds(parameters_.pause);
}

template <class Archive, class Filter>
void GuardedFilter::describe(Archive& ar, Filter& f) {
  ar.section("guarded filter", 2);
  archive_same_parameters(ar, f.parameters_);
  ar(f.aided_);
  for (auto& copy : f.copies_) {
    bool there = copy.filter.has_value();
    ar(there);
    if constexpr (Archive::loading) {
      if (there) copy.filter = f.aided_;
    }
    if (there) ar(*copy.filter);
    ar(copy.born, copy.way);
  }
  ar(f.last_, f.apart_, f.apart_since_, f.paused_until_);
}

void GuardedFilter::archive(ArchiveWriter& ar) const {
  describe(ar, *this);
}

void GuardedFilter::archive(ArchiveReader& ar) {
  GuardedFilter loaded(aided_, parameters_);
  describe(ar, loaded);
  *this = std::move(loaded);
}

}  // namespace maploop::fusion
