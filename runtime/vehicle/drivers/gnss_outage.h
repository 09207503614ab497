// Removes GNSS from parts of a drive, so that accuracy can be scored by dead reckoning alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "msgs/time.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Fixes or observations with a stamp in [begin, end) are not delivered.
struct GnssOutage {
  Time begin, end;
};

// `text` is a list, separated by commas, of START:LENGTH, repeated:START:LENGTH and
// random:COUNT:LENGTH. START and LENGTH are seconds into the drive and of the outage; LENGTH may be
// `end` for the rest of the drive in the first form. The second form adds one outage after another
// from START on, with a minute between them, as many as end in the drive. The third form adds COUNT
// outages of that length at moments drawn by `seed`, which begin a minute into the drive or later
// and do not overlap an outage listed before. `first` and `last` are the stamps of the drive's
// first and last image. The result is ordered by `begin`. Throws std::invalid_argument naming the
// part that is wrong, also if the drive is too short for it.
std::vector<GnssOutage> parse_outages(const std::string& text, Time first, Time last,
                                      std::int64_t seed);

// Returns what is wrong with the text for every drive, or an empty string if nothing is.
std::string check_outages(const std::string& text);

// T is a fix or an epoch of observations.
template <class T>
std::unique_ptr<sensors::Source<T>> with_outages(std::unique_ptr<sensors::Source<T>> source,
                                                 std::vector<GnssOutage> outages) {
  if (source == nullptr || outages.empty()) return source;
  return sensors::derived(std::move(source),
                          [outages = std::move(outages)](sensors::Source<T>& all, T& sample) {
                            const auto is_lost = [&](const GnssOutage& o) {
                              return sample.stamp >= o.begin && sample.stamp < o.end;
                            };
                            while (all.next(sample)) {
                              if (std::none_of(outages.begin(), outages.end(), is_lost))
                                return true;
                            }
                            return false;
                          });
}

}  // namespace maploop::vehicle
