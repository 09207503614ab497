#include "tools/gnss/info.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "ppp/gnss_files.h"
#include "ppp/unused_signals.h"

namespace maploop::gnss {
namespace {

using namespace maploop::ppp;

std::string row(const std::string& key, const std::string& value) {
  return "  " + key + std::string(key.size() < 14 ? 14 - key.size() : 1, ' ') + value + '\n';
}

std::string number(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

std::string span(GpsTime first, GpsTime last) {
  return format_gps_time(first) + " to " + format_gps_time(last) + " GPS time";
}

// Returns for instance "G 31, E 24".
std::string per_system(const std::set<Satellite>& satellites) {
  std::map<System, int> counts;
  for (const Satellite s : satellites) ++counts[s.system];
  std::string text;
  for (const auto& [system, count] : counts) {
    if (!text.empty()) text += ", ";
    text += std::string{letter(system), ' '} + std::to_string(count);
  }
  return text;
}

template <class Refusals>
std::string refusals(int count, const Refusals& reasons) {
  std::string text = row("refused", std::to_string(count));
  for (const auto& reason : reasons) text += "    " + reason + '\n';
  return text;
}

std::string describe(const Observations& o) {
  std::set<Satellite> satellites;
  std::map<System, std::map<std::string, int>> signals;
  std::size_t gaps = 0;
  double step = o.header.interval;
  for (std::size_t i = 1; i < o.epochs.size(); ++i) {
    const double between = to_seconds(o.epochs[i].time - o.epochs[i - 1].time);
    step = step > 0.0 ? std::min(step, between) : between;
  }
  for (std::size_t i = 0; i < o.epochs.size(); ++i) {
    const Epoch& epoch = o.epochs[i];
    if (i > 0 && to_seconds(epoch.time - o.epochs[i - 1].time) > 1.5 * step) ++gaps;
    for (const auto& s : epoch.satellites) {
      satellites.insert(s.satellite);
      for (const Signal& signal : epoch.of(s)) {
        ++signals[s.satellite.system][{signal.band, signal.attribute}];
      }
    }
  }
  std::string text = row("version", number(o.header.version, 2)) + row("marker", o.header.marker) +
                     row("receiver", o.header.receiver) +
                     row("antenna", o.header.antenna + ' ' + o.header.radome);
  if (const auto& p = o.header.approximate_position) {
    text += row("position", number(p->x(), 3) + ' ' + number(p->y(), 3) + ' ' + number(p->z(), 3) +
                                " (approximate, ECEF)");
  }
  text += row("epochs", std::to_string(o.epochs.size()) + ", every " + number(step, 3) + " s, " +
                            std::to_string(gaps) + " gaps");
  if (!o.epochs.empty()) text += row("time", span(o.epochs.front().time, o.epochs.back().time));
  text += row("satellites", per_system(satellites));
  for (const auto& [system, names] : signals) {
    std::string list;
    for (const auto& [name, count] : names) {
      list += name + " (" + std::to_string(count) + ") ";
    }
    text += row(std::string("signals ") + letter(system), list);
  }
  for (const std::string& unused : unused_systems(o.header)) text += row("unused", unused);
  return text + refusals(o.refused, o.refusals);
}

// Returns the systems whose ionosphere coefficients the file has.
std::string coefficients(const NavigationFile& n) {
  bool gps = false, galileo = false;
  for (const IonosphereMessage& m : n.ionosphere) {
    (std::holds_alternative<Klobuchar>(m.coefficients) ? gps : galileo) = true;
  }
  if (!gps && !galileo) return "no coefficients";
  return std::string(gps ? "GPS (Klobuchar)" : "") + (gps && galileo ? ", " : "") +
         (galileo ? "Galileo (NTCM-G)" : "");
}

std::string describe(const NavigationFile& n) {
  std::set<Satellite> satellites;
  GpsTime first = GpsTime::max(), last = GpsTime::min();
  const auto add = [&](Satellite s, GpsTime t) {
    satellites.insert(s);
    first = std::min(first, t);
    last = std::max(last, t);
  };
  for (const auto& m : n.kepler) add(m.satellite, m.toe);
  for (const auto& m : n.glonass) add(m.satellite, m.toe);
  std::string text = row("messages", std::to_string(n.kepler.size() + n.glonass.size()) + ", and " +
                                         std::to_string(n.skipped) + " passed over");
  if (!satellites.empty()) text += row("time", span(first, last));
  return text + row("satellites", per_system(satellites)) + row("ionosphere", coefficients(n)) +
         refusals(n.refused, n.refusals);
}

template <class Map>
std::set<Satellite> keys(const Map& map) {
  std::set<Satellite> satellites;
  for (const auto& [satellite, points] : map) satellites.insert(satellite);
  return satellites;
}

std::string describe(const OrbitFile& o) {
  std::size_t points = 0, clocks = 0;
  for (const auto& [satellite, list] : o.points) {
    for (const auto& point : list) {
      points += point.position.norm() > 0.0;
      clocks += point.has_clock;
    }
  }
  return row("agency", o.agency + ", frame " + o.frame) +
         row("epochs", std::to_string(o.epochs.size()) + ", every " +
                           number(to_seconds(o.interval), 0) + " s") +
         row("time", span(o.epochs.front(), o.epochs.back())) +
         row("satellites", per_system(keys(o.points))) +
         row("positions", std::to_string(points) + ", with clocks " + std::to_string(clocks)) +
         refusals(o.refused, std::vector<std::string>{});
}

std::string describe(const ClockFile& c) {
  std::size_t points = 0;
  GpsTime first = GpsTime::max(), last = GpsTime::min();
  for (const auto& [satellite, list] : c.points) {
    points += list.size();
    if (list.empty()) continue;
    first = std::min(first, list.front().time);
    last = std::max(last, list.back().time);
  }
  std::string text = row("agency", c.agency) + row("clocks", std::to_string(points)) +
                     row("satellites", per_system(keys(c.points)));
  if (points > 0) text += row("time", span(first, last));
  if (!c.wide_lanes.empty())
    text += row("wide lanes", std::to_string(c.wide_lanes.size()) + ", for integer ambiguities");
  return text + refusals(c.refused, std::vector<std::string>{});
}

std::string describe(const AntennaFile& a) {
  std::set<Satellite> satellites;
  std::size_t receivers = 0;
  for (const auto& antenna : a.antennas) {
    if (antenna.satellite) {
      satellites.insert(*antenna.satellite);
    } else {
      ++receivers;
    }
  }
  return row("calibration", a.absolute ? "absolute" : "relative") +
         row("satellites", per_system(satellites)) + row("receivers", std::to_string(receivers)) +
         refusals(a.refused, std::vector<std::string>{});
}

std::string describe(const BiasFile& b) {
  std::set<Satellite> satellites;
  std::map<std::string, int> signals;
  for (const auto& bias : b.biases) {
    satellites.insert(bias.satellite);
    ++signals[bias.second.empty() ? bias.signal : bias.signal + '-' + bias.second];
  }
  std::string list;
  for (const auto& [name, count] : signals) list += name + " (" + std::to_string(count) + ") ";
  return row("agency", b.agency) + row("satellites", per_system(satellites)) + row("biases", list) +
         row("passed over",
             std::to_string(b.skipped) + " of stations, between phases and between systems");
}

std::string describe(const EarthRotationFile& e) {
  return row("days", std::to_string(e.days.size()) + ", MJD " + number(e.days.front().mjd, 2) +
                         " to " + number(e.days.back().mjd, 2));
}

std::string describe(const OceanLoadingFile& o) {
  return row("stations", std::to_string(o.stations.size()));
}

std::string describe(const IonosphereMapFile& i) {
  const auto axis = [](const IonosphereMapFile::Axis& a) {
    return number(a.first, 1) + " to " + number(a.first + a.step * (a.count - 1), 1) + ", every " +
           number(std::abs(a.step), 1) + " degrees";
  };
  const bool sigmas =
      std::ranges::any_of(i.maps, [](const IonosphereMap& map) { return !map.sigma.empty(); });
  return row("maps", std::to_string(i.maps.size()) + (sigmas ? ", with standard deviations"
                                                             : ", without standard deviations")) +
         row("time", span(i.maps.front().time, i.maps.back().time)) +
         row("latitudes", axis(i.latitude)) + row("longitudes", axis(i.longitude));
}

std::string describe(const AttitudeFile& a) {
  GpsTime first = GpsTime::max(), last = GpsTime::min();
  for (const auto& [satellite, points] : a.points) {
    first = std::min(first, points.front().time);
    last = std::max(last, points.back().time);
  }
  return row("time", span(first, last)) + row("satellites", per_system(keys(a.points))) +
         refusals(a.refused, std::vector<std::string>{});
}

}  // namespace

std::string info(const std::filesystem::path& path, GnssFiles& files) {
  const FileKind kind = read_into(path, files);
  std::string text = path.string() + ": " + name(kind) + '\n';
  visit_lists([&](auto list) {
    for (const auto& file : files.*list) text += describe(file);
  });
  return text;
}

}  // namespace maploop::gnss
