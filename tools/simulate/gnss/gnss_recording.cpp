#include "tools/simulate/gnss/gnss_recording.h"

#include <string>

#include "tools/simulate/gnss/observation_text.h"
#include "tools/simulate/gnss/product_text.h"
#include "tools/simulate/gnss/receiver.h"
#include "tools/simulate/gnss/rinex_text.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/town/traffic.h"

namespace maploop::simulate {

void write_gnss(const std::filesystem::path& folder, const GnssSetting& setting) {
  const Constellation constellation(setting.seconds, setting.seed);
  Receiver receiver(constellation, setting.motion, setting.frame, setting.start, setting.seconds,
                    setting.seed);
  RayScene scene(setting.world);
  const ppp::GpsTime start = ppp::from_utc(setting.start);
  const double interval = 1.0 / setting.rate;
  ObservationText both(2, receiver.antenna_ecef(0.0), start, interval);
  ObservationText first(1, receiver.antenna_ecef(0.0), start, interval);
  std::string truth = "Index,GPS time,X,Y,Z\n";
  for (int i = 0; i * interval < setting.seconds; ++i) {
    const double t = i * interval;
    const ppp::GpsTime stamp = start + from_seconds(t);
    scene.move(bodies(setting.traffic, t, t + 0.1));
    const std::vector<ObservedSatellite> observed = receiver.observe(t, interval, scene);
    both.add(stamp, observed);
    first.add(stamp, observed);
    const Eigen::Vector3d p = receiver.antenna_ecef(t);
    truth +=
        formatted("%d,%.3f,%.4f,%.4f,%.4f\n", i, ppp::seconds_of_week(stamp), p.x(), p.y(), p.z());
  }
  const ProductSpan span{start, setting.seconds};
  const std::string navigation = navigation_text(constellation, span, setting.seed);
  const auto write = [&](const char* kind, const ObservationText& observations) {
    std::filesystem::create_directories(folder / kind);
    write_file(folder / kind / "observations.rnx", observations.text());
    write_file(folder / kind / "navigation.rnx", navigation);
    write_file(folder / kind / "truth.csv", truth);
  };
  write("gnss", both);
  write("gnss_one_frequency", first);
  const std::filesystem::path products = folder / "gnss";
  write_file(products / "orbits.sp3", orbit_text(constellation, span, setting.seed));
  write_file(products / "clocks.clk", clock_text(constellation, span, setting.seed));
  write_file(products / "antennas.atx", antenna_text(constellation));
}

}  // namespace maploop::simulate
