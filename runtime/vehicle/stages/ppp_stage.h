// The ppp thread: precise point positioning at each epoch of the GNSS receiver.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/map_feedback.h"
#include "msgs/ppp_state.h"
#include "ppp/ppp_setup.h"
#include "ppp/products/corrected.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/health/watchdog.h"
#include "runtime/vehicle/stages/antenna_track.h"
#include "runtime/vehicle/stages/ppp_counts.h"

namespace maploop::vehicle {

// Sends the state of each epoch, and a fix of each epoch that has a position. The fix comes from
// the filter without the map: its consumers receive the map's feedback themselves, and a fix with
// it would make them count it twice. An epoch takes the feedback that is available by then; on a
// live clock, the feedback that has arrived. So it does with the fused motion that carries the
// position from epoch to epoch.
class PppStage final : public GraphStage {
 public:
  // `antenna` has the place of the antenna, for the motion that carries the position.
  PppStage(Rings& rings, std::shared_ptr<const ppp::PppSetup> setup, double integrity_risk,
           const fusion::FusionParameters& antenna);

  void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) override;
  std::size_t saved_bytes() const override;
  // Takes the filter, whose ambiguities hold as long as the receiver has kept its lock, and the
  // broadcast messages that were received. The filter is forgotten if the first epoch is later by
  // more than ten minutes, or earlier.
  void recall_saved(std::span<const std::uint8_t> saved) override;
  Bytes kept() override;
  std::vector<UseWatch*> uses() override { return {&use_}; }
  // Epochs without a position, refused satellites and slips by their reasons, and restarts.
  std::vector<RefusalCount> refusals() override { return counts_.refusals(); }
  // Missing or old corrections, and missing coefficients of the ionosphere, at the last epoch.
  std::string degraded() const override;

 private:
  // The results of one epoch.
  struct Sent {
    PppState state;
    bool has_fix = false;
    GnssFix fix;
    template <class Archive>
    void archive(Archive& ar) {
      ar(state, has_fix, fix);
    }
  };

  void take(const GnssEpoch& epoch, const runtime::DataClock& clock, const std::stop_token& stop);
  void hold_feedback();
  void hold_motion();
  Time known() const;
  void take_corrections();
  void say_corrections();
  std::string wrong_with_corrections() const;
  void look_at_ionosphere(ppp::GpsTime t);
  void drain_inputs(const std::stop_token& stop);
  void use_feedback(Time until);
  void process(const GnssEpoch& epoch, const std::stop_token& stop);
  void forget_outdated(ppp::GpsTime now);
  void send(Sent& sent, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  template <class Archive>
  void archive_known(Archive& ar);
  void load(ArchiveReader& ar) override { archive(ar, Time::max()); }
  template <class Archive>
  void archive(Archive& ar, Time cut);

  std::shared_ptr<const ppp::PppSetup> setup_;       // what the filter looks at
  std::optional<ppp::CorrectedEphemeris> received_;  // of a live receiver without precise orbits
  ppp::MapAidedFilter filter_;
  double integrity_risk_;
  runtime::Edge<GnssEpoch>& epochs_;
  runtime::Edge<MapFeedback>* feedback_;         // nullptr: the map does not feed back
  runtime::Edge<FusedState>* motion_;            // nullptr: nothing carries the position
  runtime::Edge<GnssCorrections>* corrections_;  // nullptr: no stream of corrections
  Outputs<PppState> states_;
  Outputs<GnssFix> fixes_;
  UseWatch use_{stages::ppp.name, "epochs", Watchdog::patience(stages::ppp)};
  PppState state_, free_state_;    // of the last epoch, to reuse their memory
  std::vector<Sent> sent_;         // those that were not yet available at the last epoch, in order
  Sent spare_;                     // the memory of an older one, for the next
  std::vector<MapFeedback> held_;  // not yet used
  AntennaTrack track_;
  Time last_epoch_ = Time::min();  // its stamp
  Duration receiver_ahead_{};      // its clock before that of stamps
  PppCounts counts_;
  std::atomic<double> correction_age_{0.0};  // s; negative: none ever came
  // With one frequency; Duration::max(): there are none.
  std::atomic<Duration> age_of_ionosphere_{Duration::zero()};
  bool recalled_ = false;  // the filter is an earlier run's, and there was no epoch yet
};

}  // namespace maploop::vehicle
