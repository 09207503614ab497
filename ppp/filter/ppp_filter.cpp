#include "ppp/filter/ppp_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "msgs/frames.h"
#include "ppp/filter/height_update.h"
#include "ppp/filter/row_report.h"
#include "ppp/filter/signal_choice.h"
#include "ppp/filter/time_update.h"

namespace maploop::ppp {
namespace {

using S = FilterState;

constexpr double first_interval = 1.0;  // s, in place of the interval before the first epoch

// This is the definition of PppStatus::converged: m, horizontal standard deviation.
constexpr double converged_sigma = 0.1;

// Whether the motion is that of this interval, by clocks that differ a little.
bool fits(const CarriedMotion& motion, double interval) {
  constexpr double most = 0.05;  // of the interval
  return std::abs(motion.interval - interval) <= most * std::abs(interval) &&
         motion.displacement.allFinite() && motion.velocity.allFinite();
}

// Adds what all satellites have in common and no state contains.
Eigen::Matrix3d with_model_error(const Eigen::Matrix3d& position_covariance,
                                 const PppParameters& parameters) {
  return position_covariance +
         parameters.model_sigma * parameters.model_sigma * Eigen::Matrix3d::Identity();
}

}  // namespace

PppFilter::PppFilter(const PppParameters& parameters, const RangeInputs& inputs, Earth earth,
                     const HeightModel* heights)
    : parameters_(parameters),
      model_(inputs, std::move(earth)),
      heights_(heights),
      unobstructed_cn0_(parameters),
      integers_(parameters),
      rows_(parameters),
      update_(parameters),
      aid_dx_(FilterState::capacity) {}

void PppFilter::reset() {
  state_.clear();
  satellites_.reset();
  levels_.begin(1.0);
  clocks_.reset();
  started_ = false;
  off_ground_until_ = {};
  bad_epochs_ = 0;
  restarts_ = 0;
  integers_.reset();
  grown_.reset();
  solution_.status = PppStatus::none;
}

const PppSolution& PppFilter::process(const Epoch& epoch, const CarriedMotion* carried) {
  const double interval = started_ ? to_seconds(epoch.time - time_) : 0.0;
  begin_solution(epoch.time);
  std::vector<SatelliteReport>& reports = solution_.satellites;
  choose_signals(epoch, model_.inputs(), parameters_, measured_, reports);
  clock_steps_.repair(measured_);
  if (!started_ && !start(measured_, epoch.time)) return solution_;

  if (carried != nullptr && !fits(*carried, interval)) carried = nullptr;
  if (interval != 0.0) predict(interval, carried);
  time_ = epoch.time;
  const bool located = !is_lost() || locate(measured_);
  if (located) use_height();
  model_.begin(time_, state_.x().segment<3>(S::position));
  if (epoch.power_failure) satellites_.lose_lock();
  std::vector<Tracked>& tracked =
      satellites_.track(measured_, time_, interval, model_, levels_, parameters_, state_, reports);
  clocks_.set(tracked, parameters_, state_, reports);
  set_zenith_ionosphere(tracked);
  learn_strengths(tracked);
  if (!located) tracked.clear();  // about a lost position their equations are not linear
  const bool agrees = update(tracked);
  levels_.end_epoch(interval != 0.0 ? std::abs(interval) : first_interval,
                    parameters_.code_level_time);
  satellites_.forget_absent(parameters_.longest_gap, state_);
  report(tracked, agrees);

  bad_epochs_ = agrees ? 0 : bad_epochs_ + 1;
  if (bad_epochs_ >= parameters_.restart_epochs) restart();
  return solution_;
}

void PppFilter::begin_solution(GpsTime t) {
  std::vector<SatelliteReport> reports = std::move(solution_.satellites);  // reuses its memory
  solution_ = {};
  solution_.satellites = std::move(reports);
  solution_.satellites.reserve(usual_satellites);
  measured_.reserve(usual_satellites);
  solution_.time = t;
  solution_.restarts = restarts_;
}

// Returns the position by the codes alone; without one, `failed` begins the solution's message.
std::optional<SinglePoint> PppFilter::by_code(const std::vector<Measurement>& measured, GpsTime t,
                                              const char* failed) {
  SinglePoint point =
      solve_single_point(measured, t, state_.x().segment<3>(S::position), parameters_, model_);
  if (point.failure.empty()) return point;
  solution_.message = failed + point.failure;
  return std::nullopt;
}

// Starts at a position by code.
bool PppFilter::start(const std::vector<Measurement>& measured, GpsTime t) {
  const auto point = by_code(measured, t, "no first position: ");
  if (!point) return false;
  begin_state(state_, point->position, parameters_);
  levels_.begin(point->residual_level);
  started_ = true;
  started_at_ = t;
  return true;
}

// After a gap the position may be wrong by kilometres, about which no row is linear.
bool PppFilter::is_lost() const {
  const double sigma = parameters_.lost_position_sigma;
  return state_.P().block<3, 3>(S::position, S::position).trace() > sigma * sigma;
}

// Begins a lost position anew with the codes. All that does not depend on the place stays: clocks,
// delays, the errors of orbits, and the ambiguities of satellites that have been tracked since.
bool PppFilter::locate(const std::vector<Measurement>& measured) {
  const auto point = by_code(measured, time_, "the position is lost, and there is none by code: ");
  if (!point) return false;
  begin_position(state_, point->position, parameters_);
  started_at_ = time_;
  grown_.reset();
  solution_.carried.reset();
  return true;
}

// Opens the state of the ionosphere at the zenith at the first epoch: what the satellites' errors
// have in common.
void PppFilter::set_zenith_ionosphere(const std::vector<Tracked>& tracked) {
  if (state_.P()(S::zenith_ionosphere, S::zenith_ionosphere) > 0.0 || tracked.empty()) return;
  double sum = 0.0;
  for (const Tracked& t : tracked) {
    sum += t.predicted.ionosphere.sigma / t.predicted.ionosphere_slant;
  }
  const double own = parameters_.slant_ionosphere_share;
  const double share = std::sqrt(1.0 - own * own);
  const double sigma = share * sum / static_cast<double>(tracked.size());
  state_.set(S::zenith_ionosphere, 0.0, sigma);
  for (const int i : {S::ionosphere_north, S::ionosphere_east}) {
    state_.set(i, 0.0, parameters_.ionosphere_gradient_share * sigma);
  }
}

// A solution is carried only if every epoch since the last solution was. Without a measured motion
// the filter assumes one, and nobody else knows this assumption.
void PppFilter::predict(double interval, const CarriedMotion* carried) {
  const auto x = state_.x();
  const auto P = state_.P();
  const auto position = P.block<3, 3>(S::position, S::position);
  const Eigen::Matrix3d before = position;
  predict_state(state_, interval, carried, model_.ephemeris(), parameters_);
  if (carried == nullptr) grown_.reset();
  if (!grown_) return;
  *grown_ += position - before;
  solution_.carried = {x.segment<3>(S::position), with_model_error(position, parameters_),
                       x.segment<3>(S::velocity), P.block<3, 3>(S::velocity, S::velocity), *grown_};
}

void PppFilter::use_height() {
  if (heights_ == nullptr) return;
  solution_.height_use = time_ <= off_ground_until_
                             ? HeightUse::off_ground
                             : apply_height(state_, *heights_, parameters_.ground, aid_dx_);
}

void PppFilter::learn_strengths(const std::vector<Tracked>& tracked) {
  for (const Tracked& t : tracked) {
    const double cn0 = t.measurement.first.cn0;
    if (t.code_good && cn0 > 0.0) unobstructed_cn0_.add(std::sin(t.predicted.elevation), cn0);
  }
}

// Applies and reports the rows. Returns false if they disagree with the position.
bool PppFilter::update(const std::vector<Tracked>& tracked) {
  std::vector<Row>& rows = rows_.make(tracked, clocks_.reference_system(), unobstructed_cn0_,
                                      state_, solution_.satellites);
  if (rows.size() < position_unknowns) {
    if (solution_.message.empty()) solution_.message = "fewer than four measurements";
  } else {
    update_.apply(state_, rows);
    report_rows(rows, update_.dx(), tracked, state_, levels_, solution_.satellites);
  }
  return !disagree(rows, update_.dx(), tracked, parameters_);
}

void PppFilter::report(const std::vector<Tracked>& tracked, bool agrees) {
  const FilterState* const fixed = parameters_.integers
                                       ? integers_.resolve(state_, tracked, rows_.rows(), time_,
                                                           solution_.integers, solution_.satellites)
                                       : nullptr;
  const FilterState& state = fixed != nullptr ? *fixed : state_;
  const auto x = state.x();
  const auto P = state.P();
  solution_.position = x.segment<3>(S::position);
  solution_.covariance = with_model_error(P.block<3, 3>(S::position, S::position), parameters_);
  solution_.velocity = x.segment<3>(S::velocity);
  solution_.velocity_covariance = P.block<3, 3>(S::velocity, S::velocity);
  solution_.clock = x[S::clock];
  solution_.running_for = std::abs(to_seconds(time_ - started_at_));
  const ZenithDelay& guess = model_.zenith();
  solution_.zenith_delay = guess.hydrostatic + guess.wet + x[S::zenith_wet];
  solution_.zenith_delay_sigma = std::sqrt(P(S::zenith_wet, S::zenith_wet));
  for (const Tracked& t : tracked)
    solution_.satellites[t.measurement.report].ionosphere = ionosphere_of(t, state);
  for (const SatelliteReport& s : solution_.satellites) {
    solution_.satellites_used += s.code_used || s.phase_used;
  }
  const Eigen::Matrix3d& R = model_.R_enu_ecef();
  const Eigen::Matrix3d enu = R * solution_.covariance * R.transpose();
  const double horizontal_sigma = std::sqrt(enu(0, 0) + enu(1, 1));
  if (solution_.satellites_used < position_unknowns) {
    if (solution_.message.empty()) solution_.message = "fewer than four satellites";
    solution_.bridged = agrees && horizontal_sigma < parameters_.bridged_sigma;
    return;
  }
  grown_ = Eigen::Matrix3d::Zero();
  if (fixed != nullptr) solution_.carried.reset();
  const bool small = horizontal_sigma < converged_sigma;
  solution_.status = !small                                                  ? PppStatus::converging
                     : solution_.integers.used >= parameters_.integer_fewest ? PppStatus::fixed
                                                                             : PppStatus::converged;
}

void PppFilter::restart() {
  const std::uint64_t restarts = restarts_ + 1;
  reset();
  restarts_ = solution_.restarts = restarts;
  solution_.message = "started again: for " + std::to_string(parameters_.restart_epochs) +
                      " epochs measurements have disagreed with the position";
}

void PppFilter::note_road(const MapFeedback& feedback) {
  constexpr Duration lasts = std::chrono::seconds(2);  // an epoch of 1 Hz and its delay
  off_ground_until_ = feedback.off_ground ? from_utc(feedback.stamp) + lasts : GpsTime{};
}

MapUse PppFilter::add(const MapFeedback& feedback) {
  if (solution_.status == PppStatus::none) return MapUse::no_position;
  const double since = to_seconds(feedback.stamp - to_utc(time_));
  if (!(std::abs(since) <= parameters_.map_reach)) return MapUse::not_of_this_epoch;
  return apply_map(state_, feedback, since, level_covariance(), parameters_, aid_dx_);
}

Eigen::Matrix2d PppFilter::level_covariance() const {
  const Eigen::Matrix<double, 2, 3> to_east_north =
      rotation_enu_ecef(geodetic_from_ecef(solution_.position)).topRows<2>();
  return to_east_north * solution_.covariance * to_east_north.transpose();
}

}  // namespace maploop::ppp
