#include "ppp/readers/streams/ubx_subframes.h"

#include <string>

namespace maploop::ppp {
namespace {

// Collects bits one after the other, the highest first.
class BitString {
 public:
  void append(std::uint64_t value, int bits) {
    for (int i = bits - 1; i >= 0; --i) {
      if (size_ % 8 == 0) bytes_.push_back('\0');
      if ((value >> i & 1U) != 0) {
        bytes_.back() =
            static_cast<char>(static_cast<unsigned char>(bytes_.back()) | (0x80U >> (size_ % 8)));
      }
      ++size_;
    }
  }
  void append(Rtcm3Bits from, std::size_t skip, int bits) {
    from.skip(skip);
    for (int i = 0; i < bits; ++i) append(from.number(1), 1);
  }
  std::string_view bytes() const { return bytes_; }

 private:
  std::string bytes_;
  int size_ = 0;
};

std::uint32_t word(std::string_view words, std::size_t i) {
  return ubx_number<std::uint32_t>(words, 4 * i);
}

// Returns the words as the bits were sent.
BitString as_sent(std::string_view words) {
  BitString bits;
  for (std::size_t i = 0; i < words.size() / 4; ++i) bits.append(word(words, i), 32);
  return bits;
}

}  // namespace

void SubframeCollector::add_gps(Satellite satellite, std::string_view words, GpsTime now,
                                NavigationFile& to) {
  if (words.size() < 40) return;
  // The lowest six of the 30 bits are parity, which the receiver has checked.
  BitString subframe;
  for (std::size_t i = 0; i < 10; ++i) subframe.append(word(words, i) >> 6 & 0xffffffU, 24);
  Rtcm3Bits bits(subframe.bytes());
  bits.skip(24 + 19);
  const auto number = bits.number(3);
  bits.skip(2);
  Parts& parts = parts_[satellite];
  const std::span<const BroadcastField> all[3] = {broadcast_fields::gps_subframe_1,
                                                  broadcast_fields::gps_subframe_2,
                                                  broadcast_fields::gps_subframe_3};
  constexpr std::uint64_t page_18 = 0x78;  // the data identifier 1 and satellite identifier 56
  if (number == 4 && satellite.system == System::gps && bits.number(8) == page_18) {
    read_fields(bits, broadcast_fields::gps_ionosphere, parts.values);
    add_ionosphere(satellite, parts.values, now, to);
  }
  if (number < 1 || number > 3) return;
  const std::size_t part = number - 1;
  read_fields(bits, all[part], parts.values);
  // Each subframe contains its issue: the first in its eighth word (IODC), the others as IODE.
  Rtcm3Bits issue(subframe.bytes());
  issue.skip(part == 0 ? 7 * 24 : part == 1 ? 2 * 24 : 9 * 24);
  parts.issue[part] = static_cast<int>(issue.number(8));
  parts.seen |= 1U << part;
  if (parts.seen != 7U || parts.issue[0] != parts.issue[1] || parts.issue[1] != parts.issue[2])
    return;
  parts.seen = 0;
  const auto m = kepler_message(satellite, parts.values, now);
  m ? to.kepler.push_back(*m)
    : refuse(to, 0, "subframes: the values cannot be an orbit of " + to_string(satellite));
}

void SubframeCollector::add_galileo(Satellite satellite, std::string_view words, std::size_t offset,
                                    GpsTime now, NavigationFile& to) {
  if (words.size() < 32) return;
  const BitString page = as_sent(words);
  const auto at = [&](std::size_t place) {
    Rtcm3Bits bits(page.bytes());
    bits.skip(place);
    return bits;
  };
  // A page has an even half and an odd one, each starting with a bit for the half and one for the
  // page's type (alert or not).
  constexpr std::size_t odd = 128;
  if (at(0).number(2) != 0 || at(odd).number(2) != 2) return;
  BitString checked;
  checked.append(0, 4);
  checked.append(at(0), 0, 114);
  checked.append(at(odd), 0, 82);
  if (crc24q(checked.bytes()) != at(odd + 82).number(24)) {
    refuse(to, offset, "a page of " + to_string(satellite) + " has a wrong checksum");
    return;
  }
  BitString content;
  content.append(at(0), 2, 112);
  content.append(at(odd), 2, 16);
  Rtcm3Bits bits(content.bytes());
  const auto type = bits.number(6);
  const std::span<const BroadcastField> all[5] = {
      broadcast_fields::galileo_word_1, broadcast_fields::galileo_word_2,
      broadcast_fields::galileo_word_3, broadcast_fields::galileo_word_4,
      broadcast_fields::galileo_word_5};
  if (type < 1 || type > 5) return;
  const std::size_t part = type - 1;
  Parts& parts = parts_[satellite];
  if (part < 4) {
    Rtcm3Bits issue = bits;
    parts.issue[part] = static_cast<int>(issue.number(10));
  }
  read_fields(bits, all[part], parts.values);
  if (type == 5) add_ionosphere(satellite, parts.values, now, to);
  parts.seen |= 1U << part;
  const auto& i = parts.issue;
  if (parts.seen != 31U || i[0] != i[1] || i[1] != i[2] || i[2] != i[3]) return;
  parts.seen = 16U;  // health and week remain valid
  auto m = kepler_message(satellite, parts.values, now);
  if (!m) {
    refuse(to, offset, "pages: the values cannot be an orbit of " + to_string(satellite));
    return;
  }
  m->data_sources = galileo_i_nav;
  // Messages are repeated: one of each issue is enough.
  if (parts.issue[5] == i[0] + 1) return;
  parts.issue[5] = i[0] + 1;
  to.kepler.push_back(*m);
}

// All satellites repeat the coefficients: they are added only if they are new or ten minutes have
// passed.
void SubframeCollector::add_ionosphere(Satellite satellite, const BroadcastValues& values,
                                       GpsTime now, NavigationFile& to) {
  constexpr Duration while_it_is_known = std::chrono::minutes(10);
  const auto coefficients = ionosphere_coefficients(satellite.system, values);
  if (!plausible(coefficients)) return;
  const auto last = ionosphere_.find(satellite.system);
  if (last != ionosphere_.end() && last->second.coefficients == coefficients &&
      now - last->second.last < while_it_is_known)
    return;
  const IonosphereMessage message{coefficients, now, now};
  ionosphere_.insert_or_assign(satellite.system, message);
  to.ionosphere.push_back(message);
}

void SubframeCollector::add_beidou(Satellite satellite, std::string_view words, GpsTime now,
                                   NavigationFile& to) {
  if (words.size() < 40 || satellite.number <= 5 || satellite.number >= 59) return;
  // Four bits of the first word are parity, and eight of each other word.
  BitString subframe;
  subframe.append(word(words, 0) >> 4 & 0x3ffffffU, 26);
  for (std::size_t i = 1; i < 10; ++i) subframe.append(word(words, i) >> 8 & 0x3fffffU, 22);
  Rtcm3Bits bits(subframe.bytes());
  bits.skip(11 + 4);
  const auto number = bits.number(3);
  const auto second = static_cast<int>(bits.number(20));
  const std::span<const BroadcastField> all[3] = {broadcast_fields::beidou_subframe_1,
                                                  broadcast_fields::beidou_subframe_2,
                                                  broadcast_fields::beidou_subframe_3};
  if (number < 1 || number > 3) return;
  const std::size_t part = number - 1;
  Parts& parts = parts_[satellite];
  read_fields(bits, all[part], parts.values);
  parts.issue[part] = second;
  parts.seen |= 1U << part;
  // The subframes of a frame are six seconds apart.
  const auto& s = parts.issue;
  if (parts.seen != 7U || s[1] != s[0] + 6 || s[2] != s[1] + 6) return;
  parts.seen = 0;
  const auto m = kepler_message(satellite, parts.values, now);
  m ? to.kepler.push_back(*m)
    : refuse(to, 0, "subframes: the values cannot be an orbit of " + to_string(satellite));
}

void SubframeCollector::add_glonass(Satellite satellite, int channel, std::string_view words,
                                    GpsTime now, NavigationFile& to) {
  if (words.size() < 12) return;
  const BitString string = as_sent(words);
  Rtcm3Bits bits(string.bytes());
  bits.skip(1);
  const auto number = bits.number(4);
  const std::span<const BroadcastField> all[4] = {
      broadcast_fields::glonass_string_1, broadcast_fields::glonass_string_2,
      broadcast_fields::glonass_string_3, broadcast_fields::glonass_string_4};
  if (number < 1 || number > 4) return;
  Parts& parts = parts_[satellite];
  // String 1 starts a frame.
  if (number == 1) parts.seen = 0;
  read_fields(bits, all[number - 1], parts.values);
  parts.seen |= 1U << (number - 1);
  if (parts.seen != 15U) return;
  parts.seen = 0;
  parts.values[static_cast<std::size_t>(Quantity::channel)] = channel;
  const auto m = glonass_message(satellite, parts.values, now);
  if (!m) {
    refuse(to, 0, "strings: the values cannot be an orbit of " + to_string(satellite));
    return;
  }
  // Messages are repeated for half an hour: one of each interval is enough.
  const int interval = static_cast<int>(parts.values[static_cast<std::size_t>(Quantity::interval)]);
  if (parts.issue[5] == interval) return;
  parts.issue[5] = interval;
  to.glonass.push_back(*m);
}

bool SubframeCollector::add(const UbxFrame& frame, GpsTime now, NavigationFile& to) {
  if (frame.message_class != 0x02 || frame.id != 0x13) return false;
  constexpr std::size_t head = 8;
  const std::string_view payload = frame.payload;
  if (payload.size() < head || payload.size() != head + 4U * ubx_number<std::uint8_t>(payload, 4)) {
    refuse(to, frame.offset, "the size of an SFRBX message does not match its header");
    return true;
  }
  const auto satellite =
      ubx_satellite(ubx_number<std::uint8_t>(payload, 0), ubx_number<std::uint8_t>(payload, 1));
  if (!satellite) return true;
  const int signal = ubx_number<std::uint8_t>(payload, 2);
  const std::string_view words = payload.substr(head);
  switch (satellite->system) {
    case System::gps:
    case System::qzss:
      if (signal == 0) add_gps(*satellite, words, now, to);
      break;
    case System::galileo:
      if (signal == 1 || signal == 5) add_galileo(*satellite, words, frame.offset, now, to);
      break;
    case System::beidou:
      if (signal == 0) add_beidou(*satellite, words, now, to);
      break;
    case System::glonass:
      add_glonass(*satellite, ubx_number<std::uint8_t>(payload, 3), words, now, to);
      break;
    default:
      break;
  }
  return true;
}

}  // namespace maploop::ppp
