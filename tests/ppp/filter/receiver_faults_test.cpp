// Puts slips, steps of the receiver's clock and a different source of clocks into real
// observations.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "msgs/frames.h"
#include "ppp/gnss_files.h"
#include "tests/support/real_data.h"
#include "tools/ppp/run.h"

namespace maploop::ppp {
namespace {

using gnss::PppRun;
using gnss::RunOptions;
using std::chrono::milliseconds;
using std::chrono::seconds;

GnssFiles read_all(const std::vector<std::string>& names) {
  GnssFiles files;
  for (const std::string& name : names)
    read_into(maploop::testing::real_data() / "gnss" / name, files);
  return files;
}

const GnssFiles& observed_station() {
  static const GnssFiles files = read_all({"esbc_static/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz",
                                           "esbc_static/GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz",
                                           "esbc_static/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz",
                                           "esbc_static/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz",
                                           "models/igs14_rebuilt_GE.atx.gz"});
  return files;
}

const GnssFiles& observed_drive() {
  static const GnssFiles files =
      read_all({"riverside_drive/COM3_200712.obs.gz", "riverside_drive/COM3_200712.nav.gz",
                "esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz"});
  return files;
}

// From epoch `from` on, the receiver's clock is a millisecond ahead. The stamp changes with it, so
// that the codes still give the correct time of transmission.
struct ClockStep {
  std::size_t from;
  bool phases_too;
};

struct FaultRun {
  std::vector<Eigen::Vector3d> positions;
  int slips = 0;
  std::uint64_t restarts = 0;
};

FaultRun run_over(const GnssFiles& files, RunOptions options, const std::string& systems,
                  std::size_t epochs, std::optional<ClockStep> step = {}) {
  const auto& all = files.observations.at(0).epochs;
  options.parameters.systems = systems;
  options.end = all.at(epochs - 1).time;
  std::size_t at = 0;
  options.change = [&](Epoch& epoch) {
    if (!step || at++ < step->from) return;
    epoch.time += milliseconds(1);
    for (Signal& s : epoch.signals) {
      if (s.code != 0.0) s.code += 1e-3 * speed_of_light;
    }
    if (!step->phases_too) return;
    for (const SatelliteSignals& s : epoch.satellites) {
      for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
        Signal& signal = epoch.signals[i];
        const auto channel = files.observations[0].header.glonass_channels[s.satellite.number];
        const double f = carrier_frequency(s.satellite.system, signal.band, channel);
        if (signal.phase != 0.0) signal.phase += 1e-3 * f;
      }
    }
  };
  PppRun run(files, options);
  FaultRun result;
  run.process([&](const PppSolution& s) {
    result.positions.push_back(s.position);
    result.restarts = s.restarts;
    for (const SatelliteReport& r : s.satellites) result.slips += r.slip != PppSlip::none;
  });
  return result;
}

void expect_as_without(const GnssFiles& files, const RunOptions& options,
                       const std::string& systems, std::size_t epochs, double metres) {
  const FaultRun without = run_over(files, options, systems, epochs);
  ASSERT_EQ(without.positions.size(), epochs);
  for (const bool phases_too : {false, true}) {
    const FaultRun with =
        run_over(files, options, systems, epochs, ClockStep{epochs / 2, phases_too});
    EXPECT_EQ(with.restarts, without.restarts) << phases_too;
    EXPECT_LE(std::abs(with.slips - without.slips), 1) << phases_too;
    double most = 0.0;
    for (std::size_t i = 0; i < epochs; ++i)
      most = std::max(most, (with.positions[i] - without.positions[i]).norm());
    EXPECT_LT(most, metres) << phases_too;
  }
}

TEST(ReceiverFaults, AMillisecondOfTheClockLeavesAStationWhereItWas) {
  MAPLOOP_REQUIRE_REAL_DATA();
  RunOptions options;
  options.parameters.motion = Motion::fixed;
  expect_as_without(observed_station(), options, "GRE", 240, 1e-3);
}

// At 30 m/s the car drives 3 cm in a millisecond.
TEST(ReceiverFaults, AMillisecondOfTheClockLeavesACarOnOneFrequencyOnItsWay) {
  MAPLOOP_REQUIRE_REAL_DATA();
  expect_as_without(observed_drive(), {}, "GEC", 600, 0.1);
}

// Every 20 s one satellite slips by one to four cycles.
TEST(ReceiverFaults, SlipsOfSingleCyclesOnOneFrequencyAreFound) {
  MAPLOOP_REQUIRE_REAL_DATA();
  RunOptions options;
  options.parameters.systems = "GEC";
  const GpsTime first = observed_drive().observations.at(0).epochs.front().time;
  options.end = first + seconds(1500);
  std::map<GpsTime, Satellite> slipped;
  std::map<Satellite, double> cycles;  // sum of the slips so far
  int second = 0;
  std::set<Satellite> before;  // satellites with a phase
  options.change = [&](Epoch& epoch) {
    std::vector<Satellite> go_on;
    std::set<Satellite> now;
    for (const SatelliteSignals& s : epoch.satellites) {
      for (const Signal& signal : epoch.of(s)) {
        if (signal.phase == 0.0 || signal.half_cycle) continue;
        now.insert(s.satellite);
        if (before.contains(s.satellite) && !signal.lost_lock) go_on.push_back(s.satellite);
      }
    }
    before = now;
    if (++second % 20 == 0 && !go_on.empty()) {
      const auto n = static_cast<std::size_t>(second / 20);
      const Satellite victim = go_on[n * 7 % go_on.size()];
      slipped[epoch.time] = victim;
      cycles[victim] += static_cast<double>(1 + n % 4) * (n % 8 < 4 ? 1.0 : -1.0);
    }
    for (const SatelliteSignals& s : epoch.satellites) {
      for (std::uint32_t i = s.first; i < s.first + s.count; ++i) {
        if (epoch.signals[i].phase != 0.0) epoch.signals[i].phase += cycles[s.satellite];
      }
    }
  };
  PppRun run(observed_drive(), options);
  int found = 0, missed = 0, false_alarms = 0, phases = 0;
  run.process([&](const PppSolution& s) {
    const auto victim = slipped.find(s.time);
    for (const SatelliteReport& r : s.satellites) {
      phases += r.phase_used;
      const bool is_victim = victim != slipped.end() && victim->second == r.satellite;
      if (is_victim && r.elevation > radians(options.parameters.elevation_mask))
        ++(r.slip != PppSlip::none ? found : missed);
      false_alarms += !is_victim && r.slip == PppSlip::phase_step;
    }
  });
  EXPECT_GT(found + missed, 50);
  EXPECT_GE(found, 0.9 * (found + missed)) << missed << " missed";
  EXPECT_LT(false_alarms, 0.01 * phases);
  RecordProperty("found", found);
  RecordProperty("missed", missed);
  RecordProperty("false_alarms", false_alarms);
  RecordProperty("phases", phases);
}

// These are precise products whose GPS clocks count from another origin from some time on.
class AnotherSource : public PreciseEphemeris {
 public:
  AnotherSource(const GnssFiles& files, GpsTime from, double metres)
      : PreciseEphemeris(files.orbits, files.clocks, files.biases), from_(from), metres_(metres) {}
  std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const override {
    auto state = PreciseEphemeris::at(satellite, t);
    if (state && satellite.system == System::gps && t >= from_) {
      state->clock += metres_ / speed_of_light;
      state->source = 7;
    }
    return state;
  }

 private:
  GpsTime from_;
  double metres_;
};

TEST(ReceiverFaults, AnotherSourceOfTheReferencesClocksMovesNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const GpsTime switched = gps_time({2020, 6, 25, 1, 0, 0.0});
  const auto positions = [&](double metres) {
    const AnotherSource ephemeris(observed_station(), switched, metres);
    RangeInputs inputs;
    inputs.ephemeris = &ephemeris;
    inputs.antennas = &observed_station().antennas;
    PppParameters parameters;
    parameters.systems = "GE";
    PppFilter filter(parameters, inputs, Earth({}));
    std::vector<Eigen::Vector3d> all;
    for (const Epoch& epoch : observed_station().observations[0].epochs) {
      if (epoch.time > switched + seconds(1200)) break;
      all.push_back(filter.process(epoch).position);
    }
    return all;
  };
  const auto as_before = positions(0.0), later = positions(5.0);
  ASSERT_EQ(as_before.size(), later.size());
  double most = 0.0;
  for (std::size_t i = 0; i < later.size(); ++i)
    most = std::max(most, (later[i] - as_before[i]).norm());
  EXPECT_LT(most, 0.05);
}

}  // namespace
}  // namespace maploop::ppp
