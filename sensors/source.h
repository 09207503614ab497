// The one interface of a driver that replays recorded samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace maploop::sensors {

// Something wrong in the recording: where, and what.
struct Finding {
  std::string file;
  std::size_t line = 0;  // from 1; 0: the whole file
  std::string reason;
};

// What became of the recording so far. Counts are complete; of the findings only the first
// `max_findings` of each kind are kept, so that a broken recording cannot fill the memory.
struct SourceReport {
  static constexpr std::size_t max_findings = 100;

  std::uint64_t delivered = 0;
  std::uint64_t refused = 0;  // samples left out
  std::uint64_t flawed = 0;   // delivered, but with a part left out (points of a scan)
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

// A recorded sensor, read one sample at a time in the order of time. `stamp` and `available` of
// what is delivered strictly increase; `sequence` is the recording's own number, so that a sample
// left out shows as a gap. For one thread at a time; different sources share nothing that changes.
template <class T>
class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // Fills `sample` in place, reusing its buffers; false at the end (`sample` is then not to be
  // used). What is missing, cut or unreadable is left out and reported, never an exception. Sets
  // all but `received`, which belongs to whoever releases the sample.
  virtual bool next(T& sample) = 0;

  virtual const SourceReport& report() const = 0;
};

}  // namespace maploop::sensors
