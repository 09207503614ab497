// Stretches of a drive without GNSS: accuracy is scored where nothing but dead reckoning is left.
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

// Fixes, or observations, with a stamp in [begin, end) do not come.
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

// T is a fix or an epoch of observations.
template <class T>
class SourceWithOutages final : public sensors::Source<T> {
 public:
  SourceWithOutages(std::unique_ptr<sensors::Source<T>> source, std::vector<GnssOutage> outages)
      : source_(std::move(source)), outages_(std::move(outages)) {}

  bool next(T& sample) override {
    while (source_->next(sample)) {
      const bool lost = std::any_of(outages_.begin(), outages_.end(), [&](const GnssOutage& o) {
        return sample.stamp >= o.begin && sample.stamp < o.end;
      });
      if (!lost) return true;
    }
    return false;
  }

  const sensors::SourceReport& report() const override { return source_->report(); }

 private:
  std::unique_ptr<sensors::Source<T>> source_;
  std::vector<GnssOutage> outages_;
};

template <class T>
std::unique_ptr<sensors::Source<T>> with_outages(std::unique_ptr<sensors::Source<T>> source,
                                                 std::vector<GnssOutage> outages) {
  if (source == nullptr || outages.empty()) return source;
  return std::make_unique<SourceWithOutages<T>>(std::move(source), std::move(outages));
}

}  // namespace maploop::vehicle
