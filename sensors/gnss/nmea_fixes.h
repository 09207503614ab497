// This file makes fixes from the NMEA sentences of a GNSS receiver.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "msgs/gnss.h"
#include "sensors/clock/clock_offset.h"
#include "sensors/gnss/nmea.h"

namespace maploop::sensors {

struct NmeaParameters {
  // Minimum time in s from a fix to the end of its sentences; receivers take 0.03 to 0.1 s.
  double latency = 0.05;
  double max_hdop = 20.0;  // a fix with a larger HDOP is refused
  double vertical_sigma =
      0.5;  // m/s, of the climb, which no sentence contains: 3 deg of slope at 10 m/s
  double velocity_sigma = 0.1;  // m/s, of speed over ground (Doppler)
};

struct NmeaCounts {
  std::uint64_t fixes = 0;
  std::uint64_t sentences = 0;
  std::uint64_t damaged = 0;   // lines without a valid checksum
  std::uint64_t no_fix = 0;    // epochs marked invalid by the receiver, or HDOP too large
  std::uint64_t repeated = 0;  // epochs not later than the previous one
};

// A fix combines one epoch's GGA (position, quality) and RMC (date, velocity), in either order. Its
// covariance comes from a GST received before the second of them; otherwise it is HDOP times a
// sigma that depends on the quality (3 m autonomous, 1 m differential, 0.3 m float, 0.03 m fixed).
// Stamps are on the host's clock (ClockOffset). One thread at a time; does not allocate.
class NmeaFixes {
 public:
  explicit NmeaFixes(const NmeaParameters& parameters = {}) : parameters_(parameters) {}

  // Takes a line and its arrival; returns true if it completed an epoch, which is then in `fix`.
  bool add(std::string_view line, Time arrival, GnssFix& fix);

  const NmeaCounts& counts() const { return counts_; }
  // UTC of the receiver minus the host's clock, given the latency; nothing until it is known.
  std::optional<Duration> utc_offset() const { return utc_offset_; }
  const ClockOffset& clock() const { return clock_; }

 private:
  struct Position {
    Duration time{};  // since midnight
    Geodetic position;
    double sigma_horizontal = 0.0, sigma_vertical = 0.0;  // m
  };
  struct Motion {
    Time time{};
    double speed = 0.0;    // m/s
    double azimuth = 0.0;  // rad
    bool leap = false;     // second 60: the next epoch has the same time
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
  bool leap_ = false;              // the last epoch was a leap second
  Time last_stamp_ = Time::min();  // of the last fix
};

}  // namespace maploop::sensors
