// When something was wrong with a sensor for a while, told from one thread to another.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "msgs/odometry.h"
#include "msgs/time.h"
#include "runtime/core/latest_value.h"

namespace maploop::vehicle {

// A stretch of data time.
struct Episode {
  Time begin{};
  Time end{};
  std::uint64_t wrong = 0;  // samples, of `all`
  std::uint64_t all = 0;
  const char* reason = "";  // a string literal

  Duration length() const { return end - begin; }
};

// All so far, by their number and length, and the last of them.
struct Episodes {
  std::uint64_t count = 0;
  Duration total{};
  Episode last;
  bool goes_on = false;  // the last one has not ended yet

  void begin(const Episode& episode) {
    ++count;
    total += episode.length();
    last = episode;
    goes_on = true;
  }
  void extend(const Episode& episode) {
    total += episode.end - last.end;
    last.end = episode.end;
    last.wrong += episode.wrong;
    last.all += episode.all;
    last.reason = episode.reason;
  }
};

// Whether samples come. The driver's thread says each one; one other thread at a time asks. Neither
// waits or allocates.
class ArrivalWatch {
 public:
  // From `start` on no two samples should be further apart than `patience`; 0: as far as they like.
  // Before the first sample.
  void start(Time start, Duration patience) {
    patience_ = patience;
    last_.store(to_nanoseconds(start), std::memory_order_relaxed);
  }

  void arrived(Time available) {
    const Time last = this->last();
    last_.store(to_nanoseconds(std::max(last, available)), std::memory_order_relaxed);
    if (patience_ == Duration::zero() || available - last <= patience_) return;
    outages_.begin({last, available});
    outages_.goes_on = false;
    told_.back() = outages_;
    told_.publish();
  }

  // When the newest sample became available; the start where there is none.
  Time last() const { return from_nanoseconds(last_.load(std::memory_order_relaxed)); }

  // Those that have ended.
  const Episodes& outages() {
    if (const Episodes* news = told_.latest()) heard_ = *news;
    return heard_;
  }

 private:
  Duration patience_{};
  std::atomic<std::int64_t> last_{0};
  Episodes outages_;  // the driver's
  runtime::LatestValue<Episodes> told_;
  Episodes heard_;  // the reader's
};

// Whether an estimator uses what comes: stretches in which it refuses more than half. The
// estimator's thread says what became of each sample; one other thread at a time asks. Neither
// waits or allocates.
class UseWatch {
 public:
  // "STAGE refuses WHAT", judged over this length of data time, and not over fewer samples than
  // three.
  UseWatch(std::string_view stage, std::string_view what, Duration interval)
      : stage_(stage), what_(what), interval_(interval) {}

  // `refused_for`: a string literal; nullptr: it was used.
  void note(Time t, const char* refused_for) {
    if (all_ == 0) begin_ = t;
    if (t - begin_ >= interval_ && all_ >= fewest) judge(t);
    ++all_;
    if (refused_for != nullptr) count(refused_for);
  }

  // What is to be said of it; empty: all is well. Times are counted from `origin`.
  std::string sentence(Time origin);

 private:
  static constexpr std::uint64_t fewest = 3;
  struct Tally {
    const char* reason = nullptr;
    std::uint64_t count = 0;
  };

  void count(const char* reason) {
    const auto same = std::find_if(tallies_.begin(), tallies_.end(), [reason](const Tally& t) {
      return t.reason == reason || t.reason == nullptr;
    });
    if (same != tallies_.end()) *same = {reason, same->count + 1};
    ++wrong_;
  }
  void judge(Time t);

  std::string_view stage_;
  std::string_view what_;
  Duration interval_;
  // The estimator's, of the interval that runs.
  Time begin_{};
  std::uint64_t all_ = 0;
  std::uint64_t wrong_ = 0;
  std::array<Tally, 8> tallies_{};  // of the reasons; more in one interval are not told apart
  Episodes refusals_;
  runtime::LatestValue<Episodes> told_;
  Episodes heard_;  // the reader's
};

// Of an odometry. Its first frame has nothing before it.
inline void note_use(UseWatch& use, Time t, OdometryStatus status) {
  if (status == OdometryStatus::first_frame) return;
  use.note(t, status == OdometryStatus::ok ? nullptr : to_string(status).data());
}

// "imu: nothing came for 10.1 s from 15.0 s on", or nothing where there was no outage.
std::string outage_sentence(std::string_view sensor, const Episodes& outages, Time origin);

}  // namespace maploop::vehicle
