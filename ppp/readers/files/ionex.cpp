#include "ppp/readers/files/ionex.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace maploop::ppp {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

class IonexReader {
 public:
  IonexReader(Lines& lines, IonosphereMapFile& result) : lines_(lines), result_(result) {}

  void read() {
    read_header();
    while (label() != "END OF FILE") {
      if (!lines_.next()) lines_.fail("the file is cut: there is no END OF FILE");
      if (label() == "START OF TEC MAP") read_map("END OF TEC MAP", &IonosphereMap::electrons);
      if (label() == "START OF RMS MAP") read_map("END OF RMS MAP", &IonosphereMap::sigma);
      note_exponent();
    }
    for (const IonosphereMap& map : result_.maps) {
      if (map.electrons.empty()) lines_.fail("standard deviations without their map of electrons");
    }
    if (result_.maps.empty()) lines_.fail("the file contains no map of electrons");
  }

 private:
  std::string_view label() const { return trimmed(lines_.column(60, 20)); }

  // The exponent may change between any two records.
  void note_exponent() {
    if (label() == "EXPONENT") exponent_ = lines_.integer(0, 6, "exponent");
  }

  void read_header() {
    if (!lines_.next() || label() != "IONEX VERSION / TYPE" || lines_.column(20, 1) != "I") {
      lines_.fail("an IONEX file starts with IONEX VERSION / TYPE and contains an I in column 21");
    }
    const double version = lines_.number(0, 8, "version");
    if (version < 1.0 || version >= 1.2)
      lines_.fail("unknown version; IONEX 1.0 and 1.1 are supported");
    while (lines_.next()) {
      if (label() == "END OF HEADER") {
        if (result_.latitude.count == 0 || result_.longitude.count == 0)
          lines_.fail("the header does not contain the grid's latitudes and longitudes");
        return;
      }
      if (label() == "LAT1 / LAT2 / DLAT") result_.latitude = read_axis();
      if (label() == "LON1 / LON2 / DLON") result_.longitude = read_axis();
      note_exponent();
      if (label() == "HGT1 / HGT2 / DHGT" && lines_.number(14, 6, "step of heights") != 0.0)
        lines_.fail("maps of several heights are not supported");
    }
    lines_.fail("the file ends inside its header");
  }

  IonosphereMapFile::Axis read_axis() {
    constexpr double most_nodes = 1000.0;
    const double first = lines_.number(2, 6, "first node"), last = lines_.number(8, 6, "last node");
    const double step = lines_.number(14, 6, "step of nodes");
    const double steps = (last - first) / step;  // not finite if the step is zero
    if (!(steps >= 0.999 && steps < most_nodes) || std::abs(steps - std::round(steps)) > 1e-3 ||
        std::max(std::abs(first), std::abs(last)) > 360.0) {
      lines_.fail("not the first node, the last one and the step between nodes in degrees");
    }
    return {first, step, static_cast<int>(std::lround(steps)) + 1};
  }

  // Returns the map of this moment, and makes it if there is none.
  IonosphereMap& map_of(GpsTime t) {
    const auto at = std::ranges::lower_bound(result_.maps, t, {}, &IonosphereMap::time);
    if (at != result_.maps.end() && at->time == t) return *at;
    constexpr std::size_t most_maps = 2000;
    if (result_.maps.size() == most_maps) lines_.fail("more than 2000 maps");
    IonosphereMap map;
    map.time = t;
    return *result_.maps.insert(at, std::move(map));
  }

  void read_map(std::string_view end, std::vector<float> IonosphereMap::*values) {
    if (!lines_.next() || label() != "EPOCH OF CURRENT MAP")
      lines_.fail("expected EPOCH OF CURRENT MAP");
    const GpsTime utc = parse_stamp(lines_, lines_.column(0, 36));
    std::vector<float>& of = map_of(utc + leap_seconds(utc).gps_minus_utc).*values;
    const auto columns = static_cast<std::size_t>(result_.longitude.count);
    of.assign(columns * static_cast<std::size_t>(result_.latitude.count), no_value);
    while (lines_.next()) {
      if (label() == end) return;
      note_exponent();
      if (label() == "LAT/LON1/LON2/DLON/H") read_row(std::span(of), columns);
    }
    lines_.fail("the file ends inside a map");
  }

  void read_row(std::span<float> values, std::size_t columns) {
    constexpr int none = 9999;
    const auto& axis = result_.latitude;
    const double row = (lines_.number(2, 6, "latitude") - axis.first) / axis.step;
    if (!(row > -0.01 && row < axis.count - 0.99) || std::abs(row - std::round(row)) > 0.01)
      lines_.fail("the latitude is not one of the header's");
    if (std::abs(lines_.number(8, 6, "longitude") - result_.longitude.first) > 0.01)
      lines_.fail("a row must begin at the header's first longitude");
    const double unit = std::pow(10.0, exponent_);
    const auto first = static_cast<std::size_t>(std::lround(row)) * columns;
    for (std::size_t i = 0; i < columns; ++i) {
      if (i % 16 == 0 && !lines_.next()) lines_.fail("the file ends inside a map");
      const int value = lines_.integer(5 * (i % 16), 5, "number of electrons");
      if (value != none) values[first + i] = static_cast<float>(unit * value);
    }
  }

  Lines& lines_;
  IonosphereMapFile& result_;
  int exponent_ = -1;  // of ten
};

}  // namespace

IonosphereMapFile parse_ionex(std::string_view text, const std::string& file) {
  IonosphereMapFile result;
  result.file = file;
  Lines lines(text, file);
  IonexReader(lines, result).read();
  return result;
}

}  // namespace maploop::ppp
