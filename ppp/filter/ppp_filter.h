// Implements precise point positioning (ppp/METHOD.md), one epoch at a time. Its ambiguities are
// real numbers; where the products allow it, the solution is the one given their integers. It is
// single-threaded, and its results depend on the epochs and the feedback alone.
#pragma once

#include <optional>

#include "msgs/parameter_archive.h"
#include "ppp/carried_motion.h"
#include "ppp/filter/clock_steps.h"
#include "ppp/filter/code_levels.h"
#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/map_update.h"
#include "ppp/filter/parameter_table.h"
#include "ppp/filter/receiver_clocks.h"
#include "ppp/filter/robust_update.h"
#include "ppp/filter/satellite_tracker.h"
#include "ppp/filter/single_point.h"
#include "ppp/filter/unobstructed_cn0.h"
#include "ppp/heights/height_model.h"
#include "ppp/integers/integer_fix.h"

namespace maploop::ppp {

// A PppFilter estimates the position of one receiver. A copy goes on independently from the same
// state.
class PppFilter {
 public:
  // `heights` must outlive the filter; nullptr: the height of the ground is not known.
  PppFilter(const PppParameters& parameters, const RangeInputs& inputs, Earth earth,
            const HeightModel* heights = nullptr);

  // Epochs must come in the order of time, or all in the opposite order (smoothing.h). The solution
  // is valid until the next call. The work is bounded by the number of satellites: the rows of an
  // epoch are applied at most 9 times, and once more for each of `outlier_rejections`.
  // A motion that is not of the interval since the epoch before is ignored.
  const PppSolution& process(const Epoch& epoch, const CarriedMotion* carried = nullptr);

  // Applies the road of a feedback, at the feedback's stamp, to the state of the last epoch. If the
  // feedback is refused, the state keeps what it had.
  MapUse add(const MapFeedback& feedback);
  // Takes from the road that is matched whether it is on the ground. The next epochs' heights of
  // the ground are not used if it is not.
  void note_road(const MapFeedback& feedback);
  // Returns the solution of the last epoch.
  const PppSolution& solution() const { return solution_; }
  // Returns the covariance of that solution's position, east and north, m^2.
  Eigen::Matrix2d level_covariance() const;

  // Forgets everything except what is the receiver's own: its signal strengths and its clock steps.
  void reset();
  // The count of restarts begins at 0 again.
  void count_anew() { restarts_ = solution_.restarts = 0; }

  // This is the largest size of an archive, bytes.
  static constexpr std::size_t largest_archive =
      (FilterState::capacity + 1) * FilterState::capacity * sizeof(double) + satellite_slots * 160 +
      IntegerFix::largest_archive + 4096;

  // Saves and loads the filter's state. Loading refuses an archive of a filter with other
  // parameters, and the filter then stays as it was.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("ppp", 16);
    archive_same_parameters(ar, parameters_);
    archive_same_parameters(ar, parameters_.ground);
    if constexpr (Archive::loading) {
      PppFilter loaded = *this;
      loaded.archive_state(ar);
      *this = std::move(loaded);
    } else {
      archive_state(ar);
    }
  }

 private:
  template <class Archive>
  void archive_state(Archive& ar) {
    ar(state_, satellites_, levels_, unobstructed_cn0_, clock_steps_, clocks_, started_,
       started_at_, time_, off_ground_until_, bad_epochs_, restarts_, integers_, grown_,
       solution_.status, solution_.position, solution_.covariance, solution_.restarts);
  }

  void begin_solution(GpsTime t);
  std::optional<SinglePoint> by_code(const std::vector<Measurement>& measured, GpsTime t,
                                     const char* failed);
  bool start(const std::vector<Measurement>& measured, GpsTime t);
  bool is_lost() const;
  bool locate(const std::vector<Measurement>& measured);
  void predict(double interval, const CarriedMotion* carried);
  void use_height();
  void learn_strengths(const std::vector<Tracked>& tracked);
  void set_zenith_ionosphere(const std::vector<Tracked>& tracked);
  bool update(const std::vector<Tracked>& tracked);
  void report(const std::vector<Tracked>& tracked, bool agrees);
  void restart();

  PppParameters parameters_;
  RangeModel model_;
  const HeightModel* heights_;
  FilterState state_;
  SatelliteTracker satellites_;
  CodeLevels levels_;
  UnobstructedCn0 unobstructed_cn0_;  // of this receiver, like clock_steps_: both survive a restart
  ClockSteps clock_steps_;
  ReceiverClocks clocks_;
  bool started_ = false;
  GpsTime started_at_{}, time_{};
  GpsTime off_ground_until_{};
  int bad_epochs_ = 0;  // number of epochs in a row whose measurements disagree with the position
  std::uint64_t restarts_ = 0;
  IntegerFix integers_;
  // m^2, what the motions since the last solution have added to the position's covariance; nothing:
  // there is no solution yet, or an epoch since was not carried.
  std::optional<Eigen::Matrix3d> grown_;
  PppSolution solution_;

  // These belong to one call and are members only to reuse their memory.
  std::vector<Measurement> measured_;
  EpochRows rows_;
  RobustUpdate update_;
  Eigen::VectorXd aid_dx_;
};

}  // namespace maploop::ppp
