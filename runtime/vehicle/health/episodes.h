// Records when a sensor was silent or refused, and passes these episodes from one thread to
// another.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/odometry.h"
#include "msgs/time.h"
#include "runtime/core/latest_value.h"

namespace maploop::vehicle {

// An Episode is a period of data time in which something was wrong.
struct Episode {
  Time begin{};
  Time end{};
  std::uint64_t wrong = 0;  // samples that were refused, out of `all`
  std::uint64_t all = 0;
  const char* reason = "";  // a string literal

  Duration length() const { return end - begin; }
};

// Episodes summarizes all episodes so far: their number, their total length, and the last one.
struct Episodes {
  std::uint64_t count = 0;
  Duration total{};
  Episode last;
  bool goes_on = false;  // the last one has not ended yet
  Time named{};          // when the first one was judged; epoch 0: there was none

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

// ArrivalWatch records whether a sensor's samples keep coming. The driver's thread calls arrived();
// one other thread at a time calls outages(). No call blocks or allocates.
class ArrivalWatch {
 public:
  // From `start` on, a time of more than `patience` between two samples counts as an outage; with a
  // `patience` of 0 nothing does. Must be called before the first sample.
  void start(Time start, Duration patience) {
    patience_ = patience;
    last_.store(to_nanoseconds(start), std::memory_order_relaxed);
  }

  void arrived(Time available) {
    const Time last = this->last();
    last_.store(to_nanoseconds(std::max(last, available)), std::memory_order_relaxed);
    if (patience_ == Duration::zero() || available - last <= patience_) return;
    outages_.begin({last, available});
    if (outages_.named == Time{}) outages_.named = last + patience_;
    outages_.goes_on = false;
    published_.back() = outages_;
    published_.publish();
  }

  // Returns when the newest sample became available, or the start if there has been none. Any
  // thread may call this.
  Time last() const { return from_nanoseconds(last_.load(std::memory_order_relaxed)); }

  // Returns when the first outage was noticed, also one that has not ended `now`; epoch 0: there
  // was none. On the thread of outages().
  Time named(Time now, Duration patience) {
    if (outages().named != Time{}) return outages().named;
    return now - last() > patience ? last() + patience : Time{};
  }

  // Returns the outages that have ended.
  const Episodes& outages() {
    if (const Episodes* news = published_.latest()) received_ = *news;
    return received_;
  }

 private:
  Duration patience_{};
  std::atomic<std::int64_t> last_{0};
  Episodes outages_;  // owned by the driver's thread
  runtime::LatestValue<Episodes> published_;
  Episodes received_;  // owned by the reader's thread
};

// The words for what an estimator does with samples, "STAGE refuses N of M WHAT", and how many
// samples a judgement needs at least.
struct Judgement {
  std::string_view now = "refuses";
  std::string_view then = "refused";
  std::uint64_t fewest = 3;
};
// One sample is enough where the judged statistic already covers many.
inline constexpr Judgement doubts{"doubts", "doubted", 1};

// When HEALTH could name a sensor, or what an estimator makes of it, for the first time.
struct Naming {
  std::string what;  // "gnss"; "fusion doubts GNSS fixes"
  Time at{};
};

// UseWatch finds the periods in which an estimator refuses more than half of its samples. The
// estimator's thread calls note() for each sample; one other thread at a time calls sentence().
// Neither call blocks, and note() does not allocate.
class UseWatch {
 public:
  // `stage` and `what` are the words of "STAGE refuses N of M WHAT", and must outlive the watch. A
  // judgement covers at least `interval` of data time and at least `fewest` samples.
  UseWatch(std::string_view stage, std::string_view what, Duration interval,
           Judgement judgement = {})
      : stage_(stage), what_(what), interval_(interval), judgement_(judgement) {}

  // `refused_for` is the reason of a refusal as a string literal, or nullptr if the sample was
  // used.
  void note(Time t, const char* refused_for) {
    if (all_ == 0) begin_ = t;
    if (t - begin_ >= interval_ && all_ >= judgement_.fewest) judge(t);
    ++all_;
    if (refused_for != nullptr) count(refused_for);
  }

  // Returns a sentence about the last period of refusals, or an empty string if there was none. Its
  // times are in seconds since `origin`.
  std::string sentence(Time origin);

  // Returns when the first period of refusals was noticed; nothing if there was none. On the
  // reader's thread, as sentence().
  std::optional<Naming> naming();

 private:
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
  Judgement judgement_;
  // The estimator's thread owns these counts of the current interval, and refusals_.
  Time begin_{};
  std::uint64_t all_ = 0;
  std::uint64_t wrong_ = 0;
  std::array<Tally, 8> tallies_{};  // by reason; a ninth reason is not counted on its own
  Episodes refusals_;
  runtime::LatestValue<Episodes> published_;
  Episodes received_;  // owned by the reader's thread
};

// Notes a result of an odometry. The first frame is skipped, because nothing precedes it.
inline void note_use(UseWatch& use, Time t, OdometryStatus status) {
  if (status == OdometryStatus::first_frame) return;
  use.note(t, status == OdometryStatus::ok ? nullptr : to_string(status).data());
}

// Returns "imu: silent for 10.1 s from 15.0 s on", or an empty string if there was no outage.
// Its times are in seconds since `origin`.
std::string outage_sentence(std::string_view sensor, const Episodes& outages, Time origin);

}  // namespace maploop::vehicle
