// Stretches of a drive without GNSS: accuracy is scored where nothing but dead reckoning is left.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/time.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Fixes with a stamp in [begin, end) do not come.
struct GnssOutage {
  Time begin, end;
};

// `text` is a list of START:LENGTH, in seconds into the drive, LENGTH `end` for the rest of it, or
// of random:COUNT:LENGTH: so many outages of that length at moments that `seed` draws, not before a
// minute into the drive and never two at once. `first` and `last` are the drive's images. Ordered
// by their begin. Throws std::invalid_argument naming the part that is wrong, also where the drive
// is too short for the random ones.
std::vector<GnssOutage> parse_outages(const std::string& text, Time first, Time last,
                                      std::int64_t seed);

// What is wrong with the text whatever the drive; empty: nothing.
std::string check_outages(const std::string& text);

std::unique_ptr<sensors::Source<GnssFix>> with_outages(
    std::unique_ptr<sensors::Source<GnssFix>> source, std::vector<GnssOutage> outages);

}  // namespace maploop::vehicle
