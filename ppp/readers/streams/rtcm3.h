// Decodes a receiver's observations in RTCM 3 (MSM4 to MSM7).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ppp/observations.h"
#include "ppp/readers/files/navigation.h"
#include "ppp/readers/streams/rtcm3_frames.h"

namespace maploop::ppp {

// Decodes one receiver's messages in their order, from a file or as they arrive. An epoch consists
// of the messages of one time, the last of which is marked as such.
class MsmDecoder {
 public:
  // MSM contains times of the week or the day. They are resolved to the one nearest to `near`, and
  // later to the one nearest to the previous epoch.
  explicit MsmDecoder(GpsTime near) : now_(near) {}

  // Returns true if the message, or the end of the epoch before it, completes an epoch, which is
  // then in `epoch`. `problem` is set to what is wrong with an MSM message, and is empty otherwise.
  // Signals without a name in RINEX 3, phases of GLONASS without their channel (MSM4, MSM6), and
  // values that cannot be right are left out and counted.
  bool decode(const Rtcm3Message& message, Epoch& epoch, std::string& problem);
  // Returns the remaining last epoch, whose final message did not arrive; false if there is none.
  bool finish(Epoch& epoch);

  int dropped() const { return dropped_; }  // values
  const std::array<std::optional<int>, 100>& glonass_channels() const { return glonass_channels_; }

 private:
  struct Header;
  struct Key {
    Satellite satellite;
    char band, attribute;
    auto operator<=>(const Key&) const = default;
  };

  // A Tracked is the state of a signal at its last epoch.
  struct Tracked {
    bool seen = false;
    GpsTime last{};
    int lock = 0;  // lock time indicator
  };

  std::optional<GpsTime> time_of(System system, std::uint64_t field) const;
  void add(const Header& header);
  Signal signal_of(const Header& header, std::size_t satellite, std::string_view name,
                   std::size_t cell);

  GpsTime now_;
  Epoch open_;  // the epoch being collected
  std::map<Key, Tracked> tracked_;
  std::array<std::optional<int>, 100> glonass_channels_;
  int dropped_ = 0;
};

// Returns the middle of the week that an ephemeris of GPS or Galileo (1019, 1045, 1046) contains.
std::optional<GpsTime> week_of(const Rtcm3Message& message);

// Returns whether a file is a recording of such a stream: its first kilobytes contain a message
// with a right checksum.
bool is_rtcm3(std::string_view bytes);

// Parses a recording: its epochs, and the position of messages 1005 and 1006. The week is that of
// the first ephemeris of GPS or Galileo (1019, 1045, 1046). Ephemerides (rtcm3_ephemeris.h) are
// added to `navigation` unless it is nullptr. Throws ReadError if the recording has no such
// ephemeris, or no MSM.
Observations parse_rtcm3(std::string_view bytes, const std::string& file,
                         NavigationFile* navigation = nullptr);

}  // namespace maploop::ppp
