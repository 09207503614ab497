// Collects broadcast ephemerides and ionospheric coefficients from the subframes that a u-blox
// receiver passes on (UBX-RXM-SFRBX).
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "ppp/readers/files/broadcast_fields.h"
#include "ppp/readers/files/navigation.h"
#include "ppp/readers/streams/ubx_frames.h"

namespace maploop::ppp {

// Takes one receiver's messages in their order. It reads GPS and QZSS L1 C/A, Galileo I/NAV (E1-B
// and E5b), BeiDou D1 (B1I; not of geostationary satellites), GLONASS L1 and L2, and the ionosphere
// of GPS (subframe 4, page 18) and Galileo.
class SubframeCollector {
 public:
  // Adds what becomes complete to `to`; false if the frame is not an SFRBX message. Pages with a
  // wrong checksum (Galileo) and values that cannot be those of an orbit are counted there as
  // refused. `now` is as in broadcast_fields.h.
  bool add(const UbxFrame& frame, GpsTime now, NavigationFile& to);

 private:
  struct Parts {
    BroadcastValues values{};
    unsigned seen = 0;           // one bit per part
    std::array<int, 6> issue{};  // of each part that contains one
  };

  void add_gps(Satellite satellite, std::string_view words, GpsTime now, NavigationFile& to);
  void add_galileo(Satellite satellite, std::string_view words, std::size_t offset, GpsTime now,
                   NavigationFile& to);
  void add_beidou(Satellite satellite, std::string_view words, GpsTime now, NavigationFile& to);
  void add_glonass(Satellite satellite, int channel, std::string_view words, GpsTime now,
                   NavigationFile& to);

  void add_ionosphere(Satellite satellite, const BroadcastValues& values, GpsTime now,
                      NavigationFile& to);

  std::map<Satellite, Parts> parts_;
  std::map<System, IonosphereMessage> ionosphere_;  // the last one per system
};

}  // namespace maploop::ppp
