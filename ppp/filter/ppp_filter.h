// Implements precise point positioning with float ambiguities (ppp/METHOD.md), one epoch at a time.
// It is single-threaded, and its results depend on the epochs and the feedback alone.
#pragma once

#include "msgs/parameter_archive.h"
#include "ppp/filter/clock_steps.h"
#include "ppp/filter/code_levels.h"
#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/map_update.h"
#include "ppp/filter/parameter_table.h"
#include "ppp/filter/phase_steps.h"
#include "ppp/filter/range_model.h"
#include "ppp/filter/robust_update.h"
#include "ppp/filter/single_point.h"
#include "ppp/filter/slip_detector.h"
#include "ppp/filter/solution.h"
#include "ppp/filter/unobstructed_cn0.h"

namespace maploop::ppp {

class PppFilter {
 public:
  PppFilter(const PppParameters& parameters, const RangeInputs& inputs, Earth earth);

  // Epochs must come in the order of time. The solution is valid until the next call. The work is
  // bounded by the number of satellites: the rows of an epoch are applied at most 17 times.
  const PppSolution& process(const Epoch& epoch);

  // Applies the road of a feedback, at the feedback's stamp, to the state of the last epoch. If the
  // feedback is refused, the state keeps what it had.
  MapUse add(const MapFeedback& feedback);
  // Both are of the last epoch; the covariance is that of the position, east and north, m^2.
  const PppSolution& solution() const { return solution_; }
  Eigen::Matrix2d level_covariance() const;

  // Forgets everything except what is the receiver's own: its signal strengths and its clock steps.
  void reset();

  // This is the largest size of an archive, bytes.
  static constexpr std::size_t largest_archive =
      (FilterState::capacity + 1) * FilterState::capacity * sizeof(double) + satellite_slots * 160 +
      4096;

  // Saves and loads the filter's state. Loading refuses an archive of a filter with other
  // parameters, and the filter then stays as it was.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("ppp", 6);
    archive_same_parameters(ar, parameters_);
    if constexpr (Archive::loading) {
      PppFilter loaded = *this;
      loaded.archive_state(ar);
      if (loaded.memory_.size() != memory_.size() || loaded.reference_system_ < -1 ||
          loaded.reference_system_ >= system_count) {
        ar.fail("not a state of this filter");
      }
      *this = std::move(loaded);
    } else {
      archive_state(ar);
    }
  }

 private:
  template <class Archive>
  void archive_state(Archive& ar) {
    ar(state_, memory_, levels_, unobstructed_cn0_, clock_steps_, started_, started_at_, time_,
       reference_system_, has_offset_, bad_epochs_, restarts_, lasting_,
       unmodelled_ionosphere_shift_, has_map_, solution_.status, solution_.position,
       solution_.covariance, solution_.restarts);
  }

  struct Memory {  // one satellite's
    SlipDetector slips;
    double wind_up = 0.0;
    int epochs_away = 0;
    std::optional<GpsTime> last_code;
    std::uint32_t source = 0;   // the source of orbit and clock
    GpsTime message{};          // reference time of their broadcast message
    double phase_less_range{};  // m, at the last epoch with a phase
    template <class Archive>
    void archive(Archive& ar) {
      ar(slips, wind_up, epochs_away, last_code, source, message, phase_less_range);
    }
  };
  void measure_all(const Epoch& epoch);
  bool start(const Epoch& epoch);
  void predict(double interval);
  void weigh_code(Tracked& tracked, const Memory& memory) const;
  void predict_ranges(double interval);
  void change_source(Satellite satellite);
  void look_for_slips(Tracked& tracked, Memory& memory, double interval);
  void find_phase_step_slips();
  void set_clocks();
  void weigh_lasting_errors();
  void update();
  bool disagree(const std::vector<Row>& rows) const;
  void forget_absent();
  void add_lasting_error();
  void report();

  PppParameters parameters_;
  RangeModel model_;
  FilterState state_;
  std::vector<Memory> memory_;
  CodeLevels levels_;
  UnobstructedCn0 unobstructed_cn0_;  // of this receiver, like clock_steps_: both survive a restart
  ClockSteps clock_steps_;
  bool started_ = false;
  GpsTime started_at_{}, time_{};
  int reference_system_ = -1;
  std::array<bool, system_count> has_offset_{};
  int bad_epochs_ = 0;
  std::uint64_t restarts_ = 0;
  // This is the variance of the position, east and north, due to lasting errors, at the last epoch,
  // m^2.
  Eigen::Vector2d lasting_ = Eigen::Vector2d::Zero();
  // An ionosphere without a model, as large as its standard deviation, moves the position by this
  // vector; m, earth-fixed.
  Eigen::Vector3d unmodelled_ionosphere_shift_ = Eigen::Vector3d::Zero();
  bool has_map_ = false;  // whether the map's states are part of the solution

  // These belong to one epoch and are members only to reuse their memory.
  std::vector<Measurement> measurements_;
  std::vector<std::size_t> report_of_;
  std::vector<Tracked> tracked_;
  std::vector<PhaseStep> phase_steps_;
  std::vector<double> sorted_;
  EpochRows rows_;
  Eigen::VectorXd map_dx_;
  RobustUpdate update_;
  bool disagrees_ = false;
  PppSolution solution_;
};

}  // namespace maploop::ppp
