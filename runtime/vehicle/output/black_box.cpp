#include "runtime/vehicle/output/black_box.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "msgs/lcm/channel_names.h"
#include "msgs/lcm/checked_decode.h"
#include "msgs/lcm/conversions.h"
#include "msgs/lcm/log/log_header.h"
#include "runtime/vehicle/output/black_box_file.h"

namespace maploop::vehicle {
namespace {

using std::chrono::steady_clock;

constexpr auto sync_every = std::chrono::seconds(1);

using EventBytes = std::span<const std::uint8_t>;

bool says_failure(const lcm_log::LogEvent& event) {
  maploop_lcm::health_t message;
  if (!schema::checked_decode(schema::own_schema(), event.data, message)) return false;
  return std::ranges::any_of(message.threads, [](const auto& t) { return !t.failure.empty(); });
}

class BlackBoxFormat final : public LogFormat {
 public:
  BlackBoxFormat(const std::string& file, std::uint64_t bytes, std::chrono::nanoseconds after)
      : file_(file, bytes), after_(after) {
    block_.reserve(black_box::block_bytes);
    begin_block();
  }

  std::size_t write(const LogBatch& batch) override {
    if (file_.head().frozen != 0) return 0;  // that is what was asked for
    std::size_t begin = 0;
    failed_ = false;
    for (const std::size_t end : batch.ends) {
      const EventBytes bytes = EventBytes(batch.bytes).subspan(begin, end - begin);
      begin = end;
      note(lcm_log::whole_event(bytes), bytes);
      put(bytes);
    }
    write_block();
    look_around();
    return failed_ ? batch.ends.size() : 0;
  }

  std::size_t flush() override {
    file_.sync();
    return 0;
  }

  std::size_t finish() override {
    file_.set(&black_box::Head::closed);
    return flush();
  }

 private:
  void note(const lcm_log::LogEvent& event, EventBytes bytes) {
    if (event.channel == channel_names::calibration)
      calibration_.assign(bytes.begin(), bytes.end());
    if (event.channel == channel_names::snapshot) put(calibration_);
    if (event.channel == channel_names::health && !ends_ && says_failure(event))
      ends_ = steady_clock::now() + after_;
  }

  void put(EventBytes event) {
    head_.first_event = std::min(head_.first_event, used());
    while (!event.empty()) {
      const EventBytes part =
          event.first(std::min<std::size_t>(event.size(), black_box::room - used()));
      block_.insert(block_.end(), part.begin(), part.end());
      event = event.subspan(part.size());
      if (used() < black_box::room) continue;
      write_block();
      ++head_.number;
      begin_block();
    }
  }

  std::uint32_t used() const { return static_cast<std::uint32_t>(block_.size() - sizeof head_); }

  void begin_block() {
    block_.resize(sizeof head_);
    head_.run = file_.head().run;
    head_.first_event = black_box::room;
  }

  // A block that is not full is written again with what follows.
  void write_block() {
    black_box::BlockHead head = head_;
    head.used = used();
    head.first_event = std::min(head.first_event, head.used);
    std::memcpy(block_.data(), &head, sizeof head);
    head.hash = black_box::hash_of(block_);
    std::memcpy(block_.data(), &head, sizeof head);
    failed_ |= !file_.write_block(head.number % file_.head().blocks, block_);
  }

  // Once a second: brings everything to the disk, and freezes the box if it is time.
  void look_around() {
    const auto now = steady_clock::now();
    if (now - looked_ < sync_every) return;
    looked_ = now;
    file_.sync();
    if (!ends_ && file_.read_head().freeze_asked != 0) ends_ = now + after_;
    if (ends_ && now >= *ends_) file_.set(&black_box::Head::frozen);
  }

  black_box::File file_;
  std::chrono::nanoseconds after_;
  black_box::BlockHead head_;        // of the block that is being filled
  std::vector<std::uint8_t> block_;  // its head's place, then its bytes
  std::vector<std::uint8_t> calibration_;
  bool failed_ = false;  // a block of this batch was not written
  steady_clock::time_point looked_{};
  std::optional<steady_clock::time_point> ends_;
};

}  // namespace

LogFormatOf black_box_format(std::uint64_t bytes, std::chrono::nanoseconds after) {
  return [bytes, after](const std::string& file) {
    return std::make_unique<BlackBoxFormat>(file, bytes, after);
  };
}

void ask_to_freeze(const std::filesystem::path& box) {
  black_box::File file(box, black_box::File::For::asking);
  if (file.head().closed != 0 || file.head().frozen != 0) {
    throw std::runtime_error("cannot freeze " + box.string() +
                             ": its run has ended, or it is frozen; nothing more is written to it");
  }
  file.set(&black_box::Head::freeze_asked);
}

}  // namespace maploop::vehicle
