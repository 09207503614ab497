// This file defines the interface of all drivers that replay recorded samples.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace maploop::sensors {

// Describes an error in the recording: where, and what.
struct Finding {
  std::string file;
  std::size_t line = 0;  // from 1; 0 means the whole file
  std::string reason;
};

// Counts what was read of the recording so far. Counts are complete; only the first `max_findings`
// findings of each kind are kept, so that a broken recording cannot fill the memory.
struct SourceReport {
  static constexpr std::size_t max_findings = 100;

  std::uint64_t delivered = 0;
  std::uint64_t refused = 0;  // samples left out
  std::uint64_t flawed = 0;   // samples delivered with a part left out (points of a scan)
  std::vector<Finding> refusals;
  std::vector<Finding> flaws;

  void refuse(Finding finding) {
    ++refused;
    if (refusals.size() < max_findings) refusals.push_back(std::move(finding));
  }
  void flaw(Finding finding) {
    ++flawed;
    if (flaws.size() < max_findings) flaws.push_back(std::move(finding));
  }
  // Returns the reason that most of the kept refusals state, the earlier one of two as frequent
  // ones; nothing where none is refused.
  std::string_view main_reason() const {
    std::string_view most;
    std::ptrdiff_t times = 0;
    for (const Finding& f : refusals) {
      const auto of_this = std::ranges::count(refusals, f.reason, &Finding::reason);
      if (of_this > times) std::tie(most, times) = std::tie(f.reason, of_this);
    }
    return most;
  }
};

// Reads a recorded sensor, one sample at a time in the order of time. `stamp` and `available` of
// the delivered samples strictly increase; `sequence` is the recording's own number, so that an
// omitted sample shows as a gap. One thread at a time; different sources share no mutable data.
template <class T>
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // Fills `sample` in place, reusing its buffers; returns false at the end, when `sample` must not
  // be used. Missing, cut or unreadable samples are left out and reported; they never throw. Sets
  // all members but `received`, which is set by the caller that releases the sample.
  virtual bool next(T& sample) = 0;

  virtual const SourceReport& report() const = 0;
};

// Makes its samples itself: next(sample, report) fills one, and returns false at the end. It
// reports what it leaves out; the delivered ones are counted for it.
template <class T, class Next>
class MadeSource final : public Source<T> {
 public:
  explicit MadeSource(Next next) : next_(std::move(next)) {}

  bool next(T& sample) override {
    const bool more = next_(sample, report_);
    report_.delivered += more ? 1 : 0;
    return more;
  }
  const SourceReport& report() const override { return report_; }

 private:
  Next next_;
  SourceReport report_;
};

template <class T, class Next>
std::unique_ptr<Source<T>> made(Next next) {
  return std::make_unique<MadeSource<T, Next>>(std::move(next));
}

// Makes its samples from those of another source, whose report it passes on. next(source, sample)
// fills the sample from the source, and returns false at the end.
template <class T, class Next>
class DerivedSource final : public Source<T> {
 public:
  DerivedSource(std::unique_ptr<Source<T>> source, Next next)
      : source_(std::move(source)), next_(std::move(next)) {}

  bool next(T& sample) override { return next_(*source_, sample); }
  const SourceReport& report() const override { return source_->report(); }

 private:
  std::unique_ptr<Source<T>> source_;
  Next next_;
};

template <class T, class Next>
std::unique_ptr<Source<T>> derived(std::unique_ptr<Source<T>> source, Next next) {
  return std::make_unique<DerivedSource<T, Next>>(std::move(source), std::move(next));
}

}  // namespace maploop::sensors
