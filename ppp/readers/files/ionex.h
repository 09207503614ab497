// Reads IONEX 1.0 and 1.1 (Schaer, Gurtner and Feltens 1998): maps of the ionosphere's electrons.
#pragma once

#include <string>
#include <vector>

#include "ppp/readers/files/lines.h"

namespace maploop::ppp {

// Each map has the same nodes: rows from the first latitude on, each from the first longitude on.
struct IonosphereMap {
  GpsTime time{};
  std::vector<float> electrons;  // vertical content, TECU; NaN: no value
  std::vector<float> sigma;      // TECU; empty if the file does not contain it
};

struct IonosphereMapFile {
  // The steps are not 0 and may be negative.
  struct Axis {
    double first = 0.0, step = 0.0;  // deg
    int count = 0;                   // at least 2
  };
  std::string file;
  Axis latitude, longitude;
  std::vector<IonosphereMap> maps;  // at least one, in the order of time
};

// Throws ReadError for what is not IONEX, is damaged, or has maps of several heights.
IonosphereMapFile parse_ionex(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
