#include "tools/simulate/gnss/gnss_recording.h"

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "tools/simulate/gnss/product_text.h"
#include "tools/simulate/gnss/receiver.h"
#include "tools/simulate/gnss/rinex_text.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/town/site.h"

namespace maploop::simulate {
namespace {

void add_signal(std::string& line, const std::optional<ObservedSignal>& s) {
  const auto add = [&line](double value, bool lost_lock = false) {
    line += fmt::format("{:14.3f}{}", value, lost_lock ? "1 " : "  ");
  };
  constexpr std::size_t column = 16;
  if (!s) {
    line.append(4 * column, ' ');
    return;
  }
  add(s->code);
  if (s->phase) {
    add(*s->phase, s->lost_lock);
  } else {
    line.append(column, ' ');
  }
  add(s->doppler);
  add(s->cn0);
}

// Observations as RINEX 3.04.
class ObservationText {
 public:
  // `carriers` is 2, or 1 for the first carriers only. `near` is an approximate position, m, ITRF;
  // `interval` is in s.
  ObservationText(std::size_t carriers, const Eigen::Vector3d& near, ppp::GpsTime first,
                  double interval)
      : carriers_(carriers) {
    const bool both = carriers == 2;
    const ppp::CalendarTime c = ppp::calendar(first);
    for (const auto& [content, label] : std::initializer_list<std::pair<std::string, const char*>>{
             {"     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE"},
             {"maploop simulate", "PGM / RUN BY / DATE"},
             {"SIMULATED", "MARKER NAME"},
             {"MOVING", "MARKER TYPE"},
             {"", "OBSERVER / AGENCY"},
             {"1                   SIMULATED", "REC # / TYPE / VERS"},
             {std::string("1                   ") + antenna_type, "ANT # / TYPE"},
             {fmt::format("{:14.4f}{:14.4f}{:14.4f}", near.x(), near.y(), near.z()),
              "APPROX POSITION XYZ"},
             {fmt::format("{:14.4f}{:14.4f}{:14.4f}", 0.0, 0.0, 0.0), "ANTENNA: DELTA H/E/N"},
             {both ? "G    8 C1C L1C D1C S1C C2L L2L D2L S2L" : "G    4 C1C L1C D1C S1C",
              "SYS / # / OBS TYPES"},
             {both ? "E    8 C1C L1C D1C S1C C5Q L5Q D5Q S5Q" : "E    4 C1C L1C D1C S1C",
              "SYS / # / OBS TYPES"},
             {fmt::format("{:10.3f}", interval), "INTERVAL"},
             {fmt::format("{:6}{:6}{:6}{:6}{:6}{:13.7f}     GPS", c.year, c.month, c.day, c.hour,
                          c.minute, c.second),
              "TIME OF FIRST OBS"},
             {"", "END OF HEADER"}})
      text_ += header_line(content, label);
  }

  void add(ppp::GpsTime t, const std::vector<ObservedSatellite>& satellites) {
    std::string lines;
    int count = 0;
    for (const ObservedSatellite& s : satellites) {
      if (carriers_ == 1 && !s.signals[0]) continue;
      std::string line = to_string(s.satellite);
      for (std::size_t i = 0; i < carriers_; ++i) add_signal(line, s.signals[i]);
      line.erase(line.find_last_not_of(' ') + 1);
      lines += line + '\n';
      ++count;
    }
    text_ += "> " + stamp_text(t, "{:11.7f}") + fmt::format("  0{:3}\n", count) + lines;
  }

  const std::string& text() const { return text_; }

 private:
  std::size_t carriers_;
  std::string text_;
};

}  // namespace

void write_gnss(const std::filesystem::path& folder, const GnssSetting& setting) {
  const Constellation constellation(setting.seconds, setting.seed);
  Receiver receiver(constellation, setting.motion, setting.antenna, setting.frame, setting.start,
                    setting.seconds, setting.seed);
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
    truth += fmt::format("{},{:.3f},{:.4f},{:.4f},{:.4f}\n", i, ppp::seconds_of_week(stamp), p.x(),
                         p.y(), p.z());
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
