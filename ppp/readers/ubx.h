// Raw measurements of u-blox receivers (UBX-RXM-RAWX).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ppp/observations.h"
#include "ppp/readers/navigation.h"
#include "ppp/readers/ubx_frames.h"

namespace maploop::ppp {

// One receiver's messages in their order, from a file or as they come.
class RawxDecoder {
 public:
  // Fills `epoch` where the frame is a RAWX message with usable measurements. False otherwise;
  // `problem` then says what is wrong with one, and is empty of other messages. Satellites and
  // signals that have no name in RINEX 3, and pseudoranges that cannot be, are left out and
  // counted.
  bool decode(const UbxFrame& frame, Epoch& epoch, std::string& problem);

  int left_out() const { return left_out_; }  // measurements

 private:
  struct Key {
    Satellite satellite;
    char band, attribute;
    auto operator<=>(const Key&) const = default;
  };
  // Of a signal at its last epoch.
  struct Tracked {
    bool seen = false;
    GpsTime last{};
    int lock_ms = 0;
    bool half_subtracted = false;
  };

  std::optional<Key> key_of(std::string_view measurement);
  void add(const Key& key, std::string_view measurement, Epoch& epoch);

  std::map<Key, Tracked> tracked_;
  int left_out_ = 0;
};

// Whether a file is a recording of such a receiver: a sound frame begins in its first kilobytes.
bool is_ubx(std::string_view bytes);

// The epochs of a recording; its ephemerides (ubx_subframes.h) go to `navigation`, where there is
// one. Throws ReadError where it holds no raw measurements at all, saying what to switch on.
Observations parse_ubx(std::string_view bytes, const std::string& file,
                       NavigationFile* navigation = nullptr);

}  // namespace maploop::ppp
