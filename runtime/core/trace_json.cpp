#include "runtime/core/trace_json.h"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "msgs/whole_file.h"

namespace maploop::runtime {
namespace {

using Kind = TraceEvent::Kind;

// Describes a buffer at one moment.
struct Snapshot {
  const TraceBuffer* buffer;
  std::size_t recorded;
  std::uint64_t dropped;
};

// An event is written in pieces: begin(), then its own fields with their commas, then "}".
class TraceJson {
 public:
  TraceJson(const std::filesystem::path& file, MonotonicTime start)
      : file_(file), start_(start), process_(getpid()) {}

  void write(const std::vector<const TraceBuffer*>& buffers) {
    // All threads are cut at one moment. Later events are left out, so that every flow that has
    // arrived has also left; a span that ends later lasts until this moment, so that spans still
    // nest.
    end_ = monotonic_now();
    std::vector<Snapshot> snapshots;
    for (const TraceBuffer* buffer : buffers) {
      const std::uint64_t dropped = buffer->dropped();
      std::size_t recorded = buffer->recorded();
      while (recorded > 0 && buffer->event(recorded - 1).time > end_) --recorded;
      snapshots.push_back({buffer, recorded, dropped});
    }

    file_.write(R"({"displayTimeUnit":"ns","traceEvents":[)");
    begin("process_name", 'M', 0);
    file_.write(R"(,"args":{"name":"maploop"}})");
    for (std::size_t i = 0; i < snapshots.size(); ++i) write_thread(snapshots[i], i + 1);
    write_summary(snapshots);
    file_.keep();
  }

 private:
  void write_thread(const Snapshot& snapshot, std::size_t id) {
    begin("thread_name", 'M', id);
    put(R"(,"args":{{"name":{}}}}})", quoted(snapshot.buffer->name()));
    begin("thread_sort_index", 'M', id);
    put(R"(,"args":{{"sort_index":{}}}}})", id);
    for (std::size_t i = 0; i < snapshot.recorded; ++i) {
      write_event(snapshot.buffer->event(i), id);
    }
    if (snapshot.dropped == 0) return;
    begin("buffer full: events dropped from here on", 'i', id);
    put_time("ts", snapshot.buffer->first_dropped() - start_);
    put(R"(,"s":"t","args":{{"dropped":{}}}}})", snapshot.dropped);
  }

  void write_event(const TraceEvent& event, std::size_t id) {
    const std::int64_t payload = event.payload.load(std::memory_order_acquire);
    const auto value = std::bit_cast<double>(payload);
    const auto start = [&](char phase, std::string_view category = "span") {
      begin(event.name, phase, id, category);
      put_time("ts", event.time - start_);
    };
    const auto flow = [&](char phase) {
      const auto sequence = std::bit_cast<std::uint64_t>(payload);
      start(phase, "flow");  // the viewers join marks with the same category, name and id
      put(R"(,"id":"0x{:x}","args":{{"sequence":{}}})", flow_id(event.name, sequence), sequence);
    };
    switch (event.kind) {
      case Kind::span: {
        const Duration limit = end_ - event.time;
        const bool unfinished = payload == TraceEvent::open_payload || Duration(payload) > limit;
        start('X');
        put_time("dur", unfinished ? limit : Duration(payload));
        if (unfinished) file_.write(R"(,"args":{"unfinished":true})");
        break;
      }
      case Kind::instant:
        start('i');
        file_.write(R"(,"s":"t")");
        break;
      case Kind::counter:
        // JSON has no infinity and no NaN: such a value becomes an instant with the value as text.
        if (std::isfinite(value)) {
          start('C');
          put(R"(,"args":{{"value":{}}})", value);
        } else {
          start('i');
          put(R"(,"s":"t","args":{{"value":"{}"}})", value);
        }
        break;
      case Kind::flow_start:
        flow('s');
        break;
      case Kind::flow_step:
        flow('t');
        break;
      case Kind::flow_end:
        flow('f');
        file_.write(R"(,"bp":"e")");  // tied to the enclosing span, like the others
        break;
    }
    file_.write("}");
  }

  void write_summary(const std::vector<Snapshot>& snapshots) {
    std::uint64_t dropped = 0;
    for (const Snapshot& snapshot : snapshots) dropped += snapshot.dropped;
    put("],\n\"otherData\":{{\"start_monotonic_ns\":{},\"dropped\":{},\"threads\":[",
        start_.time_since_epoch().count(), dropped);
    std::string_view separator;
    for (const Snapshot& s : snapshots) {
      put("{}\n{{\"name\":{},\"capacity\":{},\"recorded\":{},\"dropped\":{}}}",
          std::exchange(separator, ","), quoted(s.buffer->name()), s.buffer->capacity(), s.recorded,
          s.dropped);
    }
    file_.write("]}}\n");
  }

  // Starts an event. Ids are the threads' numbers in the order of their buffers.
  void begin(std::string_view name, char phase, std::size_t id,
             std::string_view category = "span") {
    put("{}\n{{\"name\":{},\"cat\":\"{}\",\"ph\":\"{}\",\"pid\":{},\"tid\":{}",
        std::exchange(separator_, ","), quoted(name), category, phase, process_, id);
  }

  // Writes microseconds with three decimals. Precondition: the time is not negative.
  void put_time(std::string_view key, Duration time) {
    put(",\"{}\":{}.{:03}", key, time.count() / 1000, time.count() % 1000);
  }

  template <class... Arguments>
  void put(fmt::format_string<Arguments...> form, Arguments&&... arguments) {
    text_.clear();
    fmt::format_to(std::back_inserter(text_), form, std::forward<Arguments>(arguments)...);
    file_.write(text_);
  }

  // Returns the JSON string. Bytes that are not UTF-8 become U+FFFD. Most names are those of many
  // events.
  const std::string& quoted(std::string_view name) {
    auto found = quoted_.find(name);
    if (found == quoted_.end()) {
      constexpr auto replace = nlohmann::json::error_handler_t::replace;
      found = quoted_.emplace(name, nlohmann::json(name).dump(-1, ' ', false, replace)).first;
    }
    return found->second;
  }

  WholeFile file_;
  MonotonicTime start_;
  MonotonicTime end_{};
  int process_;
  std::string_view separator_;  // before the next event
  std::string text_;            // of the piece being written
  std::map<std::string, std::string, std::less<>> quoted_;
};

}  // namespace

void write_trace_json(const std::filesystem::path& file, MonotonicTime start,
                      const std::vector<const TraceBuffer*>& buffers) {
  TraceJson(file, start).write(buffers);
}

}  // namespace maploop::runtime
