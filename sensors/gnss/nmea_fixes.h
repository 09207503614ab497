// Fixes out of the NMEA sentences of a GNSS receiver.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "msgs/gnss.h"
#include "sensors/clock/clock_offset.h"
#include "sensors/gnss/nmea.h"

namespace maploop::sensors {

struct NmeaParameters {
  // s from the moment of a fix to the end of its sentences, at least: receivers take 0.03 to 0.1.
  double latency = 0.05;
  double max_hdop = 20.0;  // more is no fix
  double vertical_sigma =
      0.5;  // m/s, of the climb, which no sentence tells: 3 deg of slope at 10 m/s
  double velocity_sigma = 0.1;  // m/s, of speed over ground (Doppler)
};

struct NmeaCounts {
  std::uint64_t fixes = 0;
  std::uint64_t sentences = 0;
  std::uint64_t damaged = 0;   // lines without a right checksum
  std::uint64_t no_fix = 0;    // epochs of which the receiver says so, or with too large a HDOP
  std::uint64_t repeated = 0;  // epochs not later than the one before
};

// A fix is one epoch's GGA (position, quality) and RMC (date, velocity), in either order; its
// covariance is that of a GST before the second of them, else HDOP times what the quality is worth
// (3 m alone, 1 m differential, 0.3 m float, 0.03 m fixed). Stamps are on the host's clock
// (ClockOffset). One thread at a time; allocates nothing.
class NmeaFixes {
 public:
  explicit NmeaFixes(const NmeaParameters& parameters = {}) : parameters_(parameters) {}

  // A line and when it arrived: true when it completed an epoch, which is then in `fix`.
  bool add(std::string_view line, Time arrival, GnssFix& fix);

  const NmeaCounts& counts() const { return counts_; }
  // UTC of the receiver minus the host's clock, by the latency; nothing until it is known.
  std::optional<Duration> utc_offset() const { return utc_offset_; }

 private:
  struct Position {
    Duration time{};  // of the day
    Geodetic position;
    double sigma_horizontal = 0.0, sigma_vertical = 0.0;  // m
  };
  struct Motion {
    Time time{};
    double speed = 0.0;    // m/s
    double azimuth = 0.0;  // rad
  };
  struct Errors {
    Duration time{};
    double north = 0.0, east = 0.0, up = 0.0;  // m
  };

  void take_gga(const NmeaSentence& s);
  void take_rmc(const NmeaSentence& s);
  void take_gst(const NmeaSentence& s);
  bool complete(Time arrival, GnssFix& fix);

  NmeaParameters parameters_;
  ClockOffset clock_;
  NmeaCounts counts_;
  std::optional<Duration> utc_offset_;
  std::optional<Position> position_;
  std::optional<Motion> motion_;
  std::optional<Errors> errors_;
  Time last_ = Time::min();        // UTC of the last epoch
  Time last_stamp_ = Time::min();  // of the last fix
};

}  // namespace maploop::sensors
