// Counts the messages on the channels of a bus or a log.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/lcm/schema.h"
#include "msgs/time.h"
#include "runtime/vehicle/output/runs.h"
#include "tools/log/channel_filter.h"

namespace maploop::spy {

// An empty value is unknown: the rate after one message, an age without a stamp in the message,
// losses without a sequence in its header.
struct ChannelStatus {
  std::string name;
  std::string type;  // type of the last message, or its fingerprint if the type is not declared
  std::uint64_t count = 0;         // messages so far
  std::optional<double> rate_hz;   // over the window
  std::optional<double> jitter_s;  // standard deviation of the intervals in the window
  std::optional<double> age_s;  // difference of its last stamp and the newest one on all channels
  double silent_s = 0.0;        // since its last message arrived
  std::size_t bytes = 0;        // of the last message
  std::optional<std::uint64_t> lost;  // messages missing in the sequence
  std::uint64_t bad = 0;              // messages of unknown type, or not as their type defines
};

// Ages are differences of data time and do not use this machine's clock: a replay's stamps are
// years old, and a vehicle's clock may differ from ours. Therefore the newest stamp on any channel
// is `now`, and the age of a channel that falls behind grows. A sequence that goes back, or the
// stamp of a channel without sequence, has restarted: its stamp is `now`, and nothing is lost.
class Traffic {
 public:
  // The schema must outlive it.
  Traffic(const schema::Schema& schema, Duration window) : schema_(schema), window_(window) {}

  // `arrived` is on any clock that does not go back.
  void add(std::string_view channel, std::span<const std::uint8_t> data, Duration arrived);

  // Returns by name the channels that the filter selects; `now` is on the clock of the arrivals.
  std::vector<ChannelStatus> status(Duration now, const lcm_log::ChannelFilter& filter) const;

  // Returns the last message of a channel, or an empty span.
  std::span<const std::uint8_t> last(std::string_view channel) const;

  // Returns the runs that published at the time of the last message.
  std::vector<vehicle::Run> runs() const { return runs_.present(arrived_); }

  const schema::Schema& schema() const { return schema_; }
  std::uint64_t count() const { return count_; }
  // Returns the number of messages on channels beyond the first thousand, which are not
  // distinguished.
  std::uint64_t elsewhere() const { return elsewhere_; }

 private:
  struct Channel {
    std::vector<std::uint8_t> last;
    std::string type;
    std::uint64_t count = 0, bad = 0;
    std::deque<Duration> arrivals;  // within the window, at most maximum_arrivals
    std::optional<Time> stamp;
    std::optional<std::int64_t> sequence;
    std::uint64_t lost = 0;
  };

  Channel* find(std::string_view name);
  void read_header(Channel& channel);

  const schema::Schema& schema_;
  Duration window_;
  std::map<std::string, Channel, std::less<>> channels_;
  std::optional<Time> newest_;
  vehicle::RunsHeard runs_;
  Duration arrived_{};
  std::uint64_t count_ = 0, elsewhere_ = 0;
};

}  // namespace maploop::spy
