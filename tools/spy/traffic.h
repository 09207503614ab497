// What comes on the channels of a bus or a log, counted.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/lcm/decoded_message.h"
#include "msgs/lcm/schema.h"
#include "msgs/time.h"
#include "runtime/vehicle/runs.h"
#include "tools/lcm_log/channel_filter.h"

namespace maploop::spy {

// Nothing where it cannot be said: a rate of one message, an age without a stamp in the message,
// losses without a sequence in its header.
struct ChannelStatus {
  std::string name;
  std::string type;                // of the last message; its fingerprint where nobody declared it
  std::uint64_t count = 0;         // messages so far
  std::optional<double> rate_hz;   // over the window
  std::optional<double> jitter_s;  // standard deviation of the intervals in the window
  std::optional<double> age_s;     // its last stamp behind the newest one of all channels
  double silent_s = 0.0;           // since its last message came
  std::size_t bytes = 0;           // of the last message
  std::optional<std::uint64_t> lost;  // gaps of the sequence
  std::uint64_t bad = 0;              // messages of no known type, or not as their type says
};

// Ages are of the data's time and not of this machine's: a replay's stamps are years old, and a
// vehicle's clock need not be ours. So the newest stamp on any channel is `now`, and a channel that
// falls behind shows it. What starts again from the beginning (its sequence goes back) is no loss.
class Traffic {
 public:
  // The schema must outlive it.
  Traffic(const schema::Schema& schema, Duration window) : schema_(schema), window_(window) {}

  // `arrived` on any clock that does not go back.
  void add(std::string_view channel, std::span<const std::uint8_t> data, Duration arrived);

  // By name, those that the filter takes; `now` on the clock of the arrivals.
  std::vector<ChannelStatus> status(Duration now, lcm_log::ChannelFilter& filter) const;

  // The last message of a channel; empty where there is none.
  std::span<const std::uint8_t> last(std::string_view channel) const;

  // Those that publish, as of the last message.
  std::vector<vehicle::Run> runs() const { return runs_.present(arrived_); }

  std::uint64_t count() const { return count_; }
  // On channels beyond the first thousand, which are not told apart.
  std::uint64_t elsewhere() const { return elsewhere_; }

 private:
  struct Channel {
    std::vector<std::uint8_t> last;
    std::string type;
    std::uint64_t count = 0, bad = 0;
    std::deque<Duration> arrivals;  // within the window, not too many
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
  schema::DecodedMessage decoded_;
};

}  // namespace maploop::spy
