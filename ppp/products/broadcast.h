// Computes orbits and clocks from broadcast messages (IS-GPS-200, Galileo OS-SIS-ICD, BeiDou B1I
// and GLONASS ICDs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ppp/products/ephemeris.h"
#include "ppp/products/ionosphere.h"
#include "ppp/readers/files/navigation.h"

namespace maploop::ppp {

class BroadcastEphemeris : public Ephemeris {
 public:
  // Keeps at most `max_each` messages per satellite, the latest ones; by default it keeps all.
  explicit BroadcastEphemeris(const std::vector<NavigationFile>& files = {},
                              std::size_t max_each = static_cast<std::size_t>(-1));

  // Adds received messages. A message replaces one with the same reference time and, except for
  // GLONASS, the same issue.
  void add(const BroadcastMessages& messages);

  std::optional<SatelliteState> at(Satellite satellite, GpsTime t) const override;
  // Uses the message with this issue instead of the nearest. The issue is the lowest 8 bits of IODE
  // or IODnav, and for GLONASS the quarter of an hour of Moscow's day.
  std::optional<SatelliteState> at_issue(Satellite satellite, int issue, GpsTime t) const;
  bool has_issue(Satellite satellite, int issue, GpsTime t) const;
  std::optional<double> clock(Satellite satellite, GpsTime t) const override;
  double code_bias(Satellite satellite, char band, char attribute, GpsTime t) const override;
  double error_walk(Satellite) const override { return 3e-3; }
  bool centre_of_mass() const override { return false; }
  std::optional<int> glonass_channel(int number) const override;
  std::string missing(Satellite satellite, GpsTime t) const override;

  const BroadcastIonosphere& ionosphere() const { return ionosphere_; }

  // Saves the messages; loading adds them to those that are there.
  template <class Archive>
  void archive(Archive& ar) {
    ar.section("broadcast", 1);
    archive_each<KeplerMessage>(ar, kepler_);
    archive_each<GlonassMessage>(ar, glonass_);
    ar(ionosphere_);
  }

 private:
  template <class Message, class Archive>
  void archive_each(Archive& ar, const auto& lists) {
    std::uint64_t count = 0;
    for (const auto& list : lists) count += list.size();
    ar(count);
    if constexpr (Archive::loading) {
      for (Message message; count > 0; --count) {
        ar(message);
        add(message);
      }
    } else {
      for (const auto& list : lists) {
        for (const Message& message : list) ar(message);
      }
    }
  }

  void add(const KeplerMessage& message);
  void add(const GlonassMessage& message);
  // Both choose among the messages with this issue, if one is given.
  const KeplerMessage* kepler(Satellite satellite, GpsTime t, std::optional<int> issue = {}) const;
  const GlonassMessage* glonass(Satellite satellite, GpsTime t,
                                std::optional<int> issue = {}) const;

  std::size_t max_each_;
  // Both are in the order of toe: the first by slot, the second by satellite number.
  std::array<std::vector<KeplerMessage>, satellite_slots> kepler_;
  std::array<std::vector<GlonassMessage>, 100> glonass_;
  BroadcastIonosphere ionosphere_;
};

}  // namespace maploop::ppp
