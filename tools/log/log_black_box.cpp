#include <fmt/ostream.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/log/log_header.h"
#include "runtime/vehicle/output/black_box_file.h"
#include "tools/log/log_tools.h"
#include "tools/log/log_writer.h"

namespace maploop::lcm_log {
namespace {

namespace black_box = vehicle::black_box;

// A replay that resumes from a snapshot needs the samples from shortly before it on.
constexpr std::int64_t before_snapshot_us = 2'000'000;

// Reads the events of a box, oldest first.
class BoxEvents {
 public:
  explicit BoxEvents(const black_box::File& file) : file_(file) {
    std::vector<std::uint8_t> block;
    for (std::uint64_t place = 0; place < file.head().blocks; ++place) {
      if (file.read_block(place, block)) blocks_.emplace_back(head_of(block).number, place);
    }
    std::ranges::sort(blocks_);
  }

  // Whether the run's first event is there.
  bool from_the_start() const { return !blocks_.empty() && blocks_.front().first == 0; }
  // How many blocks between the others are missing or damaged.
  std::uint64_t missing() const {
    if (blocks_.empty()) return 0;
    return blocks_.back().first - blocks_.front().first + 1 - blocks_.size();
  }

  template <class Use>
  void each(const Use& use) const {
    std::vector<std::uint8_t> block, bytes;  // of events that are not read yet
    std::uint64_t expected = 0;
    for (const auto& [number, place] : blocks_) {
      if (!file_.read_block(place, block)) continue;  // it was written over meanwhile
      const black_box::BlockHead head = head_of(block);
      if (head.number != expected) bytes.clear();
      const bool begins = bytes.empty() && number != expected;
      if (begins && head.first_event == head.used) continue;
      expected = number + 1;
      const std::size_t from = sizeof head + (begins ? head.first_event : 0);
      bytes.insert(bytes.end(), block.begin() + static_cast<std::ptrdiff_t>(from), block.end());
      if (!take(bytes, use)) {
        bytes.clear();
        expected = 0;
      }
    }
  }

 private:
  static black_box::BlockHead head_of(const std::vector<std::uint8_t>& block) {
    black_box::BlockHead head;
    std::memcpy(&head, block.data(), sizeof head);
    return head;
  }

  // Uses the whole events and removes them. Returns false if something else is there.
  template <class Use>
  static bool take(std::vector<std::uint8_t>& bytes, const Use& use) {
    std::size_t at = 0;
    while (bytes.size() - at >= header_bytes) {
      const auto rest = std::span<const std::uint8_t>(bytes).subspan(at);
      const LogHeader header = read_header(rest);
      if (implausible(header)) return false;
      if (rest.size() < header.event_bytes()) break;
      use(whole_event(rest.first(header.event_bytes())));
      at += header.event_bytes();
    }
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
    return true;
  }

  const black_box::File& file_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks_;  // number, place
};

// What a replay begins with.
struct Beginning {
  std::optional<std::int64_t> snapshot_us;  // of the earliest one with enough samples before it
  std::int64_t calibration_us = 0;
  std::vector<std::uint8_t> calibration;
};

Beginning beginning_of(const BoxEvents& events) {
  Beginning b;
  std::optional<std::int64_t> oldest;
  events.each([&](const LogEvent& e) {
    const bool calibration = e.channel == channel_names::calibration;
    if (calibration && b.calibration.empty()) {
      b.calibration_us = e.time_us;
      b.calibration.assign(e.data.begin(), e.data.end());
    }
    if (calibration) return;
    if (!oldest) oldest = e.time_us;
    if (!b.snapshot_us && e.channel == channel_names::snapshot &&
        e.time_us - before_snapshot_us >= *oldest)
      b.snapshot_us = e.time_us;
  });
  if (!oldest) throw std::runtime_error("it holds no event yet");
  if (events.from_the_start()) b.snapshot_us.reset();  // a replay needs none
  return b;
}

// Writes the log and the snapshot. Returns the seconds that the log covers.
double write_log(const BoxEvents& events, const Beginning& begins, LogWriter& log,
                 const path& snapshot) {
  if (!begins.calibration.empty()) {
    log.write({.time_us = begins.calibration_us,
               .channel = channel_names::calibration,
               .data = begins.calibration});
  }
  std::int64_t first_us = std::numeric_limits<std::int64_t>::max(), last_us = 0;
  events.each([&](const LogEvent& e) {
    if (e.channel == channel_names::calibration) return;
    if (e.channel == channel_names::snapshot) {
      if (e.time_us == begins.snapshot_us) {
        write_whole_file(snapshot, e.data);
      }
      return;
    }
    if (begins.snapshot_us && e.time_us < *begins.snapshot_us - before_snapshot_us) return;
    log.write(e);
    first_us = std::min(first_us, e.time_us);
    last_us = std::max(last_us, e.time_us);
  });
  return first_us <= last_us ? 1e-6 * static_cast<double>(last_us - first_us) : 0.0;
}

const char* end_of(const black_box::Head& head) {
  if (head.frozen != 0) return "frozen";
  if (head.closed != 0) return "its run has ended";
  return "its run goes on, or did not end by itself";
}

}  // namespace

void black_box(const path& box, const schema::Schema& schema, const path& output,
               std::ostream& out) {
  refuse_same_file(box, output);
  const vehicle::black_box::File file(box, vehicle::black_box::File::For::reading);
  const BoxEvents events(file);
  path snapshot = output;
  snapshot.replace_extension(".snapshot");
  refuse_same_file(box, snapshot);
  Beginning begins;
  try {
    begins = beginning_of(events);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("the black box '" + box.string() + "': " + e.what());
  }
  LogWriter writer(output, schema);
  const double seconds = write_log(events, begins, writer, snapshot);
  writer.close();
  fmt::print(out, "{} ({}): {} events of {:.1f} s written to {}\n", box.string(),
             end_of(file.head()), writer.events(), seconds, output.string());
  if (events.missing() > 0) {
    fmt::print(out, "{} blocks of {} bytes are damaged and were left out\n", events.missing(),
               vehicle::black_box::block_bytes);
  }
  if (begins.snapshot_us) {
    fmt::print(out, "replay it with 'maploop replay {} --resume {}'\n", output.string(),
               snapshot.string());
  } else if (!events.from_the_start()) {
    fmt::print(out,
               "it holds no snapshot with the seconds before it, so that a replay starts anew\n");
  }
}

}  // namespace maploop::lcm_log
