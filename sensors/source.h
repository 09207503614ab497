// This file defines the interface of all drivers that replay recorded samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
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

}  // namespace maploop::sensors
