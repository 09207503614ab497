// The compiled part of the Python package maploop.
#include "tools/python/module.h"

PYBIND11_MODULE(_maploop, module) {
  using namespace maploop::python;
  module.doc() = R"(Vehicle localization that closes the loop through the road map.

Every stage of maploop alone, and the whole vehicle on a recording, with the same bits as the
command. Times are int nanoseconds since 1970-01-01 UTC. Units are SI, angles are radians. Frames:
enu (x east, y north, z up), body (x forward, y left, z up), cam (x right, y down, z forward), velo
(x forward, y left, z up); T_a_b maps coordinates in b to a; azimuths are clockwise from north.
Other Python threads go on while C++ works; an object that two threads use serves one after the
other.)";
  module.attr("__version__") = MAPLOOP_VERSION;
  add_config(module);
  add_samples(module);
  add_recording(module);
  add_odometry(module);
  add_fusion(module);
  add_matching(module);
  add_ppp(module);
  add_replay(module);
}
