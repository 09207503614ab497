// Tests a drive on one frequency whose ionosphere comes from maps, and from maps that end on the
// way.
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "msgs/frames.h"
#include "ppp/ppp_setup.h"
#include "tests/ppp/made_ionex.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

// Returns the drive in Riverside with the ionosphere's coefficients of another day.
GnssFiles drive_with_coefficients() {
  GnssFiles files;
  const auto data = maploop::testing::real_data() / "gnss";
  read_into(data / "riverside_drive/COM3_200712.obs.gz", files);
  read_into(data / "riverside_drive/COM3_200712.nav.gz", files);
  NavigationFile other = parse_navigation(
      read_file(data / "esbc_static/ESBC00DNK_R_20201770000_01D_MN.rnx.gz"), "other day");
  files.navigation.front().ionosphere = other.ionosphere;
  return files;
}

// Makes maps of what the broadcast coefficients say at the zenith of each node.
IonosphereMapFile maps_of_coefficients(const GnssFiles& files, int count) {
  const BroadcastEphemeris broadcast(files.navigation);
  testing::MadeMaps made{7, 12, count, {}, {}};
  const auto delay = [&](double latitude, double longitude, int hour) {
    const GpsTime t = gps_time({2020, 7, 12, 0, 0, 18.0}) + std::chrono::hours(hour);
    return ionospheric_delay(broadcast.ionosphere().at(t),
                             Geodetic{radians(latitude), radians(longitude), 0.0}, 0.0,
                             std::numbers::pi / 2.0, t);
  };
  made.electrons = [&](double latitude, double longitude, int hour) {
    return delay(latitude, longitude, hour).value / delay_of_electrons;
  };
  made.sigma = [&](double latitude, double longitude, int hour) {
    return delay(latitude, longitude, hour).sigma / delay_of_electrons;
  };
  return parse_ionex(ionex(made), "made.20i");
}

struct Drive {
  std::vector<Eigen::Vector3d> positions;
  int slips = 0;
};

Drive driven(const GnssFiles& files) {
  constexpr std::size_t epochs = 1800;  // of a second each
  SetupOptions options;
  options.parameters.systems = "GE";
  const PppSetup setup(files, options);
  PppFilter filter = setup.make_filter();
  Drive drive;
  for (std::size_t i = 0; i < epochs; ++i) {
    const PppSolution& solution = filter.process(setup.observations().epochs[i]);
    drive.positions.push_back(solution.position);
    for (const SatelliteReport& s : solution.satellites) drive.slips += s.slip != PppSlip::none;
  }
  return drive;
}

double most_apart(const Drive& a, const Drive& b, std::size_t first, std::size_t last) {
  double most = 0.0;
  for (std::size_t i = first; i < last; ++i)
    most = std::max(most, (a.positions[i] - b.positions[i]).norm());
  return most;
}

TEST(IonosphereSources, MapsOfAModelGiveItsPositionsAlsoWhereTheyEnd) {
  MAPLOOP_REQUIRE_REAL_DATA();
  GnssFiles files = drive_with_coefficients();
  const Drive by_coefficients = driven(files);
  files.ionosphere_maps.push_back(maps_of_coefficients(files, 13));
  const Drive by_maps = driven(files);
  // Klobuchar's and NTCM-G's slant differ, and nodes are rounded to 0.1 TECU.
  EXPECT_LT(most_apart(by_coefficients, by_maps, 300, 1800), 0.2);
  EXPECT_GT(most_apart(by_coefficients, by_maps, 300, 1800), 1e-4);

  EXPECT_EQ(PppSetup(files, {}).age_of_ionosphere(files.observations[0].epochs[0].time),
            Duration::zero());

  // Without coefficients the maps are followed by the usual level, decimetres away.
  files.navigation.front().ionosphere.clear();
  const Drive whole = driven(files);
  files.ionosphere_maps.front() = maps_of_coefficients(drive_with_coefficients(), 2);
  const Drive ending = driven(files);
  const std::size_t end = 1434;  // 2:00:18
  EXPECT_EQ(most_apart(whole, ending, 0, end), 0.0);
  // A step of the model would move the position by 0.33 m at once.
  EXPECT_LT(most_apart(whole, ending, end, end + 2), 0.005);
  EXPECT_LT(most_apart(whole, ending, end, end + 60), 0.15);
  EXPECT_EQ(whole.slips, ending.slips);
}

}  // namespace
}  // namespace maploop::ppp
