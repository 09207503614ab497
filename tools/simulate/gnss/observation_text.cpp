#include "tools/simulate/gnss/observation_text.h"

#include "tools/simulate/gnss/rinex_text.h"

namespace maploop::simulate {
namespace {

void add_value(std::string& line, double value, bool lost_lock) {
  line += formatted("%14.3f", value);
  line += lost_lock ? "1 " : "  ";
}

void add_signal(std::string& line, const std::optional<ObservedSignal>& s) {
  constexpr std::size_t column = 16;
  if (!s) {
    line.append(4 * column, ' ');
    return;
  }
  add_value(line, s->code, false);
  if (s->phase)
    add_value(line, *s->phase, s->lost_lock);
  else
    line.append(column, ' ');
  add_value(line, s->doppler, false);
  add_value(line, s->cn0, false);
}

}  // namespace

ObservationText::ObservationText(std::size_t carriers, const Eigen::Vector3d& near,
                                 ppp::GpsTime first, double interval)
    : carriers_(carriers) {
  const bool both = carriers == 2;
  text_ += header_line("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE");
  text_ += header_line("maploop simulate", "PGM / RUN BY / DATE");
  text_ += header_line("SIMULATED", "MARKER NAME");
  text_ += header_line("MOVING", "MARKER TYPE");
  text_ += header_line("", "OBSERVER / AGENCY");
  text_ += header_line("1                   SIMULATED", "REC # / TYPE / VERS");
  text_ += header_line(std::string("1                   ") + antenna_type, "ANT # / TYPE");
  text_ += header_line(formatted("%14.4f%14.4f%14.4f", near.x(), near.y(), near.z()),
                       "APPROX POSITION XYZ");
  text_ += header_line(formatted("%14.4f%14.4f%14.4f", 0.0, 0.0, 0.0), "ANTENNA: DELTA H/E/N");
  text_ += header_line(both ? "G    8 C1C L1C D1C S1C C2L L2L D2L S2L" : "G    4 C1C L1C D1C S1C",
                       "SYS / # / OBS TYPES");
  text_ += header_line(both ? "E    8 C1C L1C D1C S1C C5Q L5Q D5Q S5Q" : "E    4 C1C L1C D1C S1C",
                       "SYS / # / OBS TYPES");
  text_ += header_line(formatted("%10.3f", interval), "INTERVAL");
  const ppp::CalendarTime c = ppp::calendar(first);
  text_ += header_line(formatted("%6d%6d%6d%6d%6d%13.7f     GPS", c.year, c.month, c.day, c.hour,
                                 c.minute, c.second),
                       "TIME OF FIRST OBS");
  text_ += header_line("", "END OF HEADER");
}

void ObservationText::add(ppp::GpsTime t, const std::vector<ObservedSatellite>& satellites) {
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
  text_ += "> " + stamp_text(t, "%11.7f") + formatted("  0%3d\n", count) + lines;
}

}  // namespace maploop::simulate
