#include "ppp/readers/streams/rtcm3_ephemeris.h"

#include "ppp/readers/files/broadcast_fields.h"

namespace maploop::ppp {
namespace {

struct EphemerisKind {
  System system;
  std::size_t number_bits;  // of the satellite
  std::span<const BroadcastField> fields, end;
};

std::optional<EphemerisKind> ephemeris_kind(int message) {
  switch (message) {
    case 1019:
      return EphemerisKind{System::gps, 6, broadcast_fields::rtcm_1019, {}};
    case 1020:
      return EphemerisKind{System::glonass, 6, broadcast_fields::rtcm_1020, {}};
    case 1042:
      return EphemerisKind{System::beidou, 6, broadcast_fields::rtcm_1042, {}};
    case 1044:
      return EphemerisKind{System::qzss, 4, broadcast_fields::rtcm_1044, {}};
    case 1045:
      return EphemerisKind{System::galileo, 6, broadcast_fields::rtcm_galileo,
                           broadcast_fields::rtcm_1045_end};
    case 1046:
      return EphemerisKind{System::galileo, 6, broadcast_fields::rtcm_galileo,
                           broadcast_fields::rtcm_1046_end};
    default:
      return {};
  }
}

}  // namespace

bool add_ephemeris(const Rtcm3Message& message, GpsTime now, NavigationFile& to) {
  const auto kind = ephemeris_kind(message.number);
  if (!kind) return false;
  Rtcm3Bits bits(message.payload);
  bits.skip(12);
  const Satellite satellite{kind->system,
                            static_cast<std::uint8_t>(bits.number(kind->number_bits))};
  BroadcastValues values{};
  read_fields(bits, kind->fields, values);
  read_fields(bits, kind->end, values);
  const std::string what = "message " + std::to_string(message.number);
  if (!bits.good() || satellite.number == 0) {
    refuse(to, message.offset, what + " is incomplete or has no satellite number");
    return true;
  }
  if (kind->system == System::glonass) {
    const auto m = glonass_message(satellite, values, now);
    m ? to.glonass.push_back(*m)
      : refuse(to, message.offset,
               what + ": the values cannot be an orbit of " + to_string(satellite));
    return true;
  }
  auto m = kepler_message(satellite, values, now);
  if (!m) {
    refuse(to, message.offset, what + ": the values cannot be an orbit of " + to_string(satellite));
    return true;
  }
  if (kind->system == System::galileo) {
    m->data_sources = message.number == 1045 ? galileo_f_nav : galileo_i_nav;
  }
  to.kepler.push_back(*m);
  return true;
}

}  // namespace maploop::ppp
