// Observations of a receiver in RTCM 3 (MSM4 to MSM7).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "ppp/observations.h"
#include "ppp/readers/navigation.h"
#include "ppp/readers/rtcm3_frames.h"

namespace maploop::ppp {

// One receiver's messages in their order, from a file or as they come. An epoch is what messages of
// one time say; the last of them says that it is.
class MsmDecoder {
 public:
  // MSM says times of the week or the day: the one nearest to `near`, and from then on to the epoch
  // before.
  explicit MsmDecoder(GpsTime near) : now_(near) {}

  // True when the message, or the end of the epoch before it, completes an epoch, which is then in
  // `epoch`. `problem` says what is wrong with an MSM message; empty of all others. Signals without
  // a name in RINEX 3, phases of GLONASS without their channel (MSM4, MSM6), and what cannot be are
  // left out and counted.
  bool decode(const Rtcm3Message& message, Epoch& epoch, std::string& problem);
  // What is left of a last epoch that was not said to be whole.
  bool finish(Epoch& epoch);

  int left_out() const { return left_out_; }  // values
  const std::array<std::optional<int>, 100>& glonass_channels() const { return glonass_channels_; }

 private:
  struct Header;
  struct Key {
    Satellite satellite;
    char band, attribute;
    auto operator<=>(const Key&) const = default;
  };

  // Of a signal at its last epoch.
  struct Tracked {
    bool seen = false;
    GpsTime last{};
    int lock = 0;  // indicator
  };

  std::optional<GpsTime> time_of(System system, std::uint64_t field) const;
  void add(const Header& header);
  Signal signal_of(const Header& header, std::size_t satellite, std::string_view name,
                   std::size_t cell);

  GpsTime now_;
  Epoch open_;  // being collected
  std::map<Key, Tracked> tracked_;
  std::array<std::optional<int>, 100> glonass_channels_;
  int left_out_ = 0;
};

// The middle of the week that an ephemeris of GPS or Galileo (1019, 1045, 1046) says.
std::optional<GpsTime> week_of(const Rtcm3Message& message);

// Whether a file is a recording of such a stream: a sound message begins in its first kilobytes.
bool is_rtcm3(std::string_view bytes);

// The epochs of a recording, and the position of messages 1005 and 1006. The week is that of the
// first ephemeris of GPS or Galileo (1019, 1045, 1046). Throws ReadError where the recording has no
// such ephemeris, or no MSM. Its ephemerides (rtcm3_ephemeris.h) go to `navigation`, where there is
// one.
Observations parse_rtcm3(std::string_view bytes, const std::string& file,
                         NavigationFile* navigation = nullptr);

}  // namespace maploop::ppp
