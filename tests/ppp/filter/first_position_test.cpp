// Starts on few of a station's satellites, and with systems whose clocks are far apart.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "msgs/median.h"
#include "ppp/ppp_setup.h"
#include "tests/support/real_data.h"

namespace maploop::ppp {
namespace {

const Eigen::Vector3d truth(3582104.7678, 532590.1740, 5232755.1436);

const GnssFiles& station_with_broadcast_orbits() {
  static const GnssFiles files = [] {
    GnssFiles read;
    for (const char* name :
         {"ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz", "ESBC00DNK_R_20201770000_01D_MN.rnx.gz"})
      read_into(maploop::testing::real_data() / "gnss/esbc_static" / name, read);
    return read;
  }();
  return files;
}

void delay(Epoch& epoch, const SatelliteSignals& satellite, double metres) {
  for (std::uint32_t i = satellite.first; i < satellite.first + satellite.count; ++i) {
    if (epoch.signals[i].code != 0.0) epoch.signals[i].code += metres;
  }
}

// Returns the median, over the hours of a day, of the error of the position that two epochs give,
// m.
double error_of_starts(double clock_difference_sigma, const std::function<void(Epoch&)>& change) {
  SetupOptions options;
  options.parameters.systems = "GE";
  options.parameters.clock_difference_sigma = clock_difference_sigma;
  const PppSetup setup(station_with_broadcast_orbits(), options);
  const std::vector<Epoch>& epochs = setup.observations().epochs;
  std::vector<double> errors;
  for (std::size_t at = 0; at + 1 < epochs.size(); at += 120) {
    PppFilter filter = setup.make_filter();
    PppSolution last;
    for (std::size_t i = at; i < at + 2; ++i) {
      Epoch epoch = epochs[i];
      change(epoch);
      last = filter.process(epoch);
    }
    if (last.status == PppStatus::none) continue;
    errors.push_back((last.position - truth).norm());
  }
  EXPECT_GE(errors.size(), 12U) << "of 24";
  return median(errors);
}

// Leaves the first satellites of GPS and of Galileo.
void keep_five(Epoch& epoch) {
  int gps = 0, galileo = 0;
  std::erase_if(epoch.satellites, [&](const SatelliteSignals& s) {
    if (s.satellite.system == System::gps) return ++gps > 3;
    return s.satellite.system != System::galileo || ++galileo > 2;
  });
}

TEST(FirstPosition, AClockThatIsKnownToMetresStandsForASatellite) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const double known = error_of_starts(PppParameters{}.clock_difference_sigma, keep_five);
  const double unknown = error_of_starts(1e6, keep_five);
  EXPECT_LT(known, 0.5 * unknown);
}

TEST(FirstPosition, ASystemWhoseClockIsFarOffMovesNoPosition) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const auto usual = [](Epoch&) {};
  const auto far = [](Epoch& epoch) {
    for (const SatelliteSignals& s : epoch.satellites) {
      if (s.satellite.system == System::galileo) delay(epoch, s, 200.0);
    }
  };
  const double sigma = PppParameters{}.clock_difference_sigma;
  const double near_error = error_of_starts(sigma, usual), far_error = error_of_starts(sigma, far);
  EXPECT_LT(far_error, 1.2 * near_error);
}

}  // namespace
}  // namespace maploop::ppp
