// Drives of tables through the vehicle's own graph: cars with neither camera nor LiDAR.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "msgs/input_file.h"
#include "runtime/core/data_clock.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* gnss_rows =
    "t_s,lat_deg,lon_deg,height_m,vn_mps,ve_mps,vd_mps,pos_std_n_m,pos_std_e_m,pos_std_d_m,"
    "vel_std_n_mps,vel_std_e_mps,vel_std_d_mps\n"
    "0,43.5,-79.7,100,5,0,0,0.4,0.5,0.6,0.1,0.2,0.3\n"
    "1,43.5,-79.7,100,5,0,0,0.4,0.5,0.6,0.1,0.2,0.3\n"
    "2,43.5,-79.7,100,5,0,0,0.4,0.5,0.6,0.1,0.2,0.3\n";
constexpr const char* imu_rows =
    "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n0,0,0,0,0,0,9.8\n1,0,0,0,0,0,9.8\n";

void write(const fs::path& file, const char* text) {
  std::ofstream(file) << text;
}

TEST(TableDrive, ChoosesItsConfigurationUnlessTheFileDoes) {
  const maploop::testing::TemporaryFolder folder;
  VehicleConfig other;
  fit_to_recording(other, folder.path());  // no tables
  EXPECT_EQ(other.configuration, VehicleConfig{}.configuration);
  write(folder.path() / "gnss.csv", gnss_rows);
  VehicleConfig fixes;
  fit_to_recording(fixes, folder.path());
  EXPECT_EQ(fixes.configuration, "GNSS");
  write(folder.path() / "imu.csv", imu_rows);
  VehicleConfig both;
  fit_to_recording(both, folder.path());
  EXPECT_EQ(both.configuration, "GNSS+RI");
  EXPECT_EQ(both.imu_grade, "mems");
  EXPECT_TRUE(both.fusion.use_gnss);
  VehicleConfig chosen;
  chosen.given = {".configuration", ".imu_grade"};
  fit_to_recording(chosen, folder.path());
  EXPECT_EQ(chosen.configuration, VehicleConfig{}.configuration);
  EXPECT_EQ(chosen.imu_grade, "tactical");
}

TEST(TableDrive, ASensorThatItLacksOrThatIsNotAskedForDoesNotExist) {
  const maploop::testing::TemporaryFolder folder;
  write(folder.path() / "gnss.csv", gnss_rows);
  VehicleConfig config;
  fit_to_recording(config, folder.path());
  EXPECT_EQ(open_recording(folder.path(), config).sensors(Time::min()).imu, nullptr);
  write(folder.path() / "imu.csv", imu_rows);
  EXPECT_EQ(open_recording(folder.path(), config).sensors(Time::min()).imu, nullptr);  // GNSS
  set_configuration(config, "GNSS+RI");
  config.gnss_outage = "0.5:1";
  const Recording recording = open_recording(folder.path(), config);
  const Sensors sensors = recording.sensors(Time::min());
  EXPECT_NE(sensors.imu, nullptr);
  EXPECT_EQ(sensors.camera, nullptr);
  EXPECT_EQ(sensors.wheel, nullptr);
  EXPECT_EQ(sensors.reference, nullptr);
  EXPECT_EQ(recording.images, 3u);
  std::size_t seen = 0, all = 0;
  for (GnssFix fix; sensors.gnss->next(fix);) ++seen;
  const auto fixes = recording.fixes();
  for (GnssFix fix; fixes->next(fix);) ++all;
  EXPECT_EQ(seen, 2u);
  EXPECT_EQ(all, 3u);
  set_configuration(config, "RI");
  EXPECT_THAT(error_of([&] { open_recording(folder.path(), config); }), HasSubstr("GNSS+RI"));
}

struct ReplayedTables {
  std::vector<NavState> states;
  VehicleReport report;
};

ReplayedTables run(const Recording& recording, const VehicleConfig& config) {
  ReplayedTables driven;
  Observer observer;
  observer.nav_state = [&](const NavState& state) {
    if (state.sequence % 10 == 0) driven.states.push_back(state);
  };
  Vehicle vehicle(config, recording.calibration, recording.sensors(Time::min()),
                  runtime::DataClock::virtual_time(), {}, std::move(observer), nullptr, nullptr);
  vehicle.start();
  vehicle.wait();
  driven.report = vehicle.report();
  return driven;
}

// A short drive of a car in Oakville, with an outage at 90 s.
class OakvilleDrive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_REAL_DATA();
    folder_ = maploop::testing::real_data() / "cars/oakville/urban-short-turn-loop-nominal-002";
    if (!fs::exists(folder_)) GTEST_SKIP() << "SKIPPED, NOT TESTED: there is no " << folder_;
    fit_to_recording(config_, folder_);
  }
  fs::path folder_;
  VehicleConfig config_;
};

TEST_F(OakvilleDrive, StaysOnItsFixesAndNearThemThroughAShortOutage) {
  config_.gnss_outage = "90:10";
  const Recording recording = open_recording(folder_, config_);
  const ReplayedTables driven = run(recording, config_);
  std::vector<double> errors;
  const auto fixes = recording.fixes();
  std::size_t next = 0;
  for (GnssFix fix; fixes->next(fix);) {
    while (next < driven.states.size() && driven.states[next].stamp < fix.stamp) ++next;
    if (next == driven.states.size()) break;
    const NavState& state = driven.states[next];
    if (state.status == NavStatus::uninitialized) continue;
    const Eigen::Vector3d p = LocalFrame(state.origin).to_enu(fix.position);
    errors.push_back((state.position_enu - p).head<2>().norm());
  }
  ASSERT_GT(errors.size(), 300u);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 25.0);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 1.5);  // up to 0.1 s of driving is between state and fix
  EXPECT_GT(driven.states.back().zero_velocity_stamp, Time{});
}

// The fix that the filter starts from is wrong: by its place, or by its direction.
TEST_F(OakvilleDrive, RecoversFromAWrongFirstFix) {
  const maploop::testing::TemporaryFolder changed;
  fs::create_symlink(folder_ / "imu.csv.gz", changed.path() / "imu.csv.gz");
  const std::string text = read_text(folder_ / "gnss.csv.gz", 1 << 24);
  struct Change {
    std::size_t column;
    double factor, offset;
  };
  for (const auto& changes : {std::vector<Change>{{1, 1.0, 0.003}},  // deg: 330 m
                              std::vector<Change>{{4, -1.0, 0.0}, {5, -1.0, 0.0}}}) {
    std::istringstream lines(text);
    std::ofstream out(changed.path() / "gnss.csv");
    bool wrong = false;
    for (std::string line; std::getline(lines, line); out << line << '\n') {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (wrong || cells.at(0) == "t_s") continue;
      wrong = std::hypot(std::stod(cells[4]), std::stod(cells[5])) > 2.0;
      if (!wrong) continue;
      line.clear();
      for (const Change& c : changes)
        cells[c.column] = std::to_string(c.factor * std::stod(cells[c.column]) + c.offset);
      for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + cell;
    }
    out.close();
    const Recording recording = open_recording(changed.path(), config_);
    const ReplayedTables driven = run(recording, config_);
    const NavState& end = driven.states.back();
    GnssFix last;
    const auto fixes = recording.fixes();
    while (fixes->next(last)) {
    }
    const Eigen::Vector3d p = LocalFrame(end.origin).to_enu(last.position);
    EXPECT_LT((end.position_enu - p).head<2>().norm(), 5.0);
  }
}

// A delay that the receiver does not have makes the stamps of its fixes too early.
TEST_F(OakvilleDrive, SaysThatTheStampsOfItsFixesAreEarly) {
  const auto as_recorded = run(open_recording(folder_, config_), config_).report;
  EXPECT_THAT(as_recorded.health.degraded, Not(Contains(StartsWith("gnss: its stamps are"))));
  config_.vehicle.antenna.time.delay = 0.2;
  const auto early = run(open_recording(folder_, config_), config_).report;
  const auto delay =
      std::ranges::find(early.calibration, "gnss_delay", &fusion::CalibratedProperty::key);
  EXPECT_NEAR(delay->value, -200.0, 60.0);
  EXPECT_THAT(early.health.degraded, Contains(StartsWith("gnss: its stamps are")));
}

// Fixes of the outage do not reach the search for the mount either: until its end nothing differs
// from a drive that has no fixes at all.
TEST_F(OakvilleDrive, AMountIsNotFoundFromFixesThatAnOutageTakesAway) {
  config_.gnss_outage = "0:end";
  const ReplayedTables driven = run(open_recording(folder_, config_), config_);
  const auto imu = std::find_if(driven.report.sensors.begin(), driven.report.sensors.end(),
                                [](const SensorReport& s) { return s.name == "imu"; });
  ASSERT_NE(imu, driven.report.sensors.end());
  EXPECT_EQ(imu->source.delivered, 0u);
  EXPECT_GT(imu->source.refused, 10'000u);
}

}  // namespace
}  // namespace maploop::vehicle
