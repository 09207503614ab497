// Decodes raw measurements of u-blox receivers (UBX-RXM-RAWX).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ppp/observations.h"
#include "ppp/readers/files/navigation.h"
#include "ppp/readers/streams/ubx_frames.h"

namespace maploop::ppp {

// Decodes one receiver's messages in their order, from a file or as they arrive.
class RawxDecoder {
 public:
  // Returns true and fills `epoch` if the frame is a RAWX message with usable measurements.
  // Otherwise `problem` is set to what is wrong with a RAWX message, and is empty for other
  // messages. Satellites and signals without a name in RINEX 3, and pseudoranges that cannot be
  // right, are left out and counted.
  bool decode(const UbxFrame& frame, Epoch& epoch, std::string& problem);

  int dropped() const { return dropped_; }  // measurements

 private:
  struct Key {
    Satellite satellite;
    char band, attribute;
    auto operator<=>(const Key&) const = default;
  };
  // A Tracked is the state of a signal at its last epoch.
  struct Tracked {
    bool seen = false;
    GpsTime last{};
    int lock_ms = 0;
    bool half_subtracted = false;
  };

  std::optional<Key> key_of(std::string_view measurement);
  void add(const Key& key, std::string_view measurement, Epoch& epoch);

  std::map<Key, Tracked> tracked_;
  int dropped_ = 0;
};

// Returns whether a file is a recording of such a receiver: its first kilobytes contain a frame
// with a right checksum.
bool is_ubx(std::string_view bytes);

// Parses the epochs of a recording. Ephemerides (ubx_subframes.h) are added to `navigation` unless
// it is nullptr. Throws ReadError if it contains no raw measurements; the error names the message
// to enable.
Observations parse_ubx(std::string_view bytes, const std::string& file,
                       NavigationFile* navigation = nullptr);

}  // namespace maploop::ppp
