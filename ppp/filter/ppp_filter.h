// Precise point positioning with float ambiguities (ppp/METHOD.md), an epoch at a time. Plain
// and single-threaded: what it says depends on the epochs alone.
#pragma once

#include "ppp/filter/clock_steps.h"
#include "ppp/filter/code_levels.h"
#include "ppp/filter/epoch_rows.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/full_strength.h"
#include "ppp/filter/map_update.h"
#include "ppp/filter/parameters.h"
#include "ppp/filter/phase_steps.h"
#include "ppp/filter/range_model.h"
#include "ppp/filter/robust_update.h"
#include "ppp/filter/single_point.h"
#include "ppp/filter/slip_detector.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

class PppFilter {
 public:
  PppFilter(const PppParameters& parameters, const Surroundings& surroundings, Earth earth);

  // Epochs in the order of time. The solution is valid until the next call. Work is bounded by the
  // number of satellites and 16 passes over them.
  const PppSolution& process(const Epoch& epoch);

  // The road at the feedback's stamp, about the state of the last epoch. Nothing is forgotten where
  // it is refused.
  MapUse add(const MapFeedback& feedback);
  const PppSolution& solution() const { return solution_; }  // of the last epoch
  Eigen::Matrix2d level_covariance() const;                  // the same one's, east and north, m^2

  // Forgets everything.
  void reset();

  // Memory that what it saves takes at most.
  static constexpr std::size_t largest_archive =
      (FilterState::capacity + 1) * FilterState::capacity * sizeof(double) + satellite_slots * 160 +
      4096;

  // Saves and loads what it knows; loading refuses a filter with other parameters. A filter that
  // refused is as it was.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("ppp", 5);
    archive_same_fields(ar, parameters_);
    archive_same(ar, "choice of systems", parameters_.systems);
    if constexpr (Archive::loading) {
      PppFilter loaded = *this;
      loaded.archive_knowledge(ar);
      if (loaded.memory_.size() != memory_.size() || loaded.reference_system_ < -1 ||
          loaded.reference_system_ >= system_count) {
        ar.fail("no state of this filter");
      }
      *this = std::move(loaded);
    } else {
      archive_knowledge(ar);
    }
  }

 private:
  template <class Archive>
  void archive_knowledge(Archive& ar) {
    ar(state_, memory_, levels_, strength_, clock_steps_, started_, begun_, time_,
       reference_system_, has_offset_, bad_epochs_, restarts_, lasting_, unmodelled_, has_map_,
       solution_.status, solution_.position, solution_.covariance, solution_.restarts);
  }

  struct Memory {  // of a satellite
    SlipDetector slips;
    double wind_up = 0.0;
    int epochs_away = 0;
    std::optional<GpsTime> last_code;
    std::uint32_t source = 0;   // of orbit and clock
    GpsTime message{};          // the same
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
  void compare_phase_steps();
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
  FullStrength strength_;  // of this receiver, as is the next: kept when all begins anew
  ClockSteps clock_steps_;
  bool started_ = false;
  GpsTime begun_{}, time_{};
  int reference_system_ = -1;
  std::array<bool, system_count> has_offset_{};
  int bad_epochs_ = 0;
  std::uint64_t restarts_ = 0;
  // m^2, east and north: of the position, by errors that last; of the last epoch.
  Eigen::Vector2d lasting_ = Eigen::Vector2d::Zero();
  // m, earth-fixed: what an ionosphere without a model, by its deviation, moves the position by.
  Eigen::Vector3d unmodelled_ = Eigen::Vector3d::Zero();
  bool has_map_ = false;  // whose states are part of the solution

  // Of one epoch; members only to reuse their memory.
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
