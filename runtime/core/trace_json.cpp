#include "runtime/core/trace_json.h"

#include <unistd.h>

#include <bit>
#include <cmath>
#include <string>

#include "runtime/core/trace_text.h"
#include "runtime/core/whole_file.h"

namespace maploop::runtime {
namespace {

using Kind = TraceEvent::Kind;

// Describes a buffer at one moment.
struct Snapshot {
  const TraceBuffer* buffer;
  std::size_t recorded;
  std::uint64_t dropped;
};

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

    file_.write("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[");
    begin("process_name", 'M', 0);
    text_ += R"(,"args":{"name":"maploop"}})";
    file_.write(text_);
    for (std::size_t i = 0; i < snapshots.size(); ++i) write_thread(snapshots[i], i + 1);
    write_summary(snapshots);
    file_.keep();
  }

 private:
  void write_thread(const Snapshot& snapshot, std::size_t id) {
    begin("thread_name", 'M', id);
    text_ += ",\"args\":{\"name\":";
    append_json(text_, snapshot.buffer->name());
    text_ += "}}";
    file_.write(text_);
    begin("thread_sort_index", 'M', id);
    text_ += ",\"args\":{\"sort_index\":";
    append_number(text_, id);
    text_ += "}}";
    file_.write(text_);
    for (std::size_t i = 0; i < snapshot.recorded; ++i) {
      write_event(snapshot.buffer->event(i), id);
    }
    if (snapshot.dropped > 0) write_drops(snapshot, id);
  }

  void write_event(const TraceEvent& event, std::size_t id) {
    const std::int64_t payload = event.payload.load(std::memory_order_acquire);
    switch (event.kind) {
      case Kind::span:
        begin(event.name, 'X', id);
        write_span(event.time, payload);
        break;
      case Kind::instant:
        begin(event.name, 'i', id);
        append_stamp(event.time);
        text_ += R"(,"s":"t")";
        break;
      case Kind::counter:
        write_counter(event, std::bit_cast<double>(payload), id);
        break;
      case Kind::flow_start:
        write_flow(event, 's', id);
        break;
      case Kind::flow_step:
        write_flow(event, 't', id);
        break;
      case Kind::flow_end:
        write_flow(event, 'f', id);
        text_ += R"(,"bp":"e")";  // tied to the enclosing span, like the others
        break;
    }
    text_ += '}';
    file_.write(text_);
  }

  void write_span(MonotonicTime start, std::int64_t duration) {
    const Duration limit = end_ - start;
    const bool unfinished = duration == TraceEvent::kOpen || Duration(duration) > limit;
    append_stamp(start);
    text_ += ",\"dur\":";
    append_microseconds(text_, unfinished ? limit : Duration(duration));
    if (unfinished) text_ += R"(,"args":{"unfinished":true})";
  }

  // JSON has no infinity and no NaN: such a value becomes an instant with the value as text.
  void write_counter(const TraceEvent& event, double value, std::size_t id) {
    const bool finite = std::isfinite(value);
    begin(event.name, finite ? 'C' : 'i', id);
    append_stamp(event.time);
    text_ += finite ? R"(,"args":{"value":)" : R"(,"s":"t","args":{"value":")";
    append_number(text_, value);
    text_ += finite ? "}" : "\"}";
  }

  // The viewers join marks with the same category, name and id.
  void write_flow(const TraceEvent& event, char phase, std::size_t id) {
    const auto sequence =
        std::bit_cast<std::uint64_t>(event.payload.load(std::memory_order_relaxed));
    begin(event.name, phase, id, "flow");
    append_stamp(event.time);
    text_ += ",\"id\":\"0x";
    append_hexadecimal(text_, flow_id(event.name, sequence));
    text_ += R"(","args":{"sequence":)";
    append_number(text_, sequence);
    text_ += '}';
  }

  void write_drops(const Snapshot& snapshot, std::size_t id) {
    begin("buffer full: events dropped from here on", 'i', id);
    append_stamp(snapshot.buffer->first_dropped());
    text_ += R"(,"s":"t","args":{"dropped":)";
    append_number(text_, snapshot.dropped);
    text_ += "}}";
    file_.write(text_);
  }

  void write_summary(const std::vector<Snapshot>& snapshots) {
    std::uint64_t dropped = 0;
    for (const Snapshot& snapshot : snapshots) dropped += snapshot.dropped;
    text_ = "],\n\"otherData\":{\"start_monotonic_ns\":";
    append_number(text_, start_.time_since_epoch().count());
    text_ += ",\"dropped\":";
    append_number(text_, dropped);
    text_ += ",\"threads\":[";
    file_.write(text_);
    for (std::size_t i = 0; i < snapshots.size(); ++i) {
      text_ = i == 0 ? "\n{\"name\":" : ",\n{\"name\":";
      append_json(text_, snapshots[i].buffer->name());
      text_ += ",\"capacity\":";
      append_number(text_, snapshots[i].buffer->capacity());
      text_ += ",\"recorded\":";
      append_number(text_, snapshots[i].recorded);
      text_ += ",\"dropped\":";
      append_number(text_, snapshots[i].dropped);
      text_ += '}';
      file_.write(text_);
    }
    file_.write("]}}\n");
  }

  // Starts an event. Ids are the threads' numbers in the order of their buffers.
  void begin(std::string_view name, char phase, std::size_t id,
             std::string_view category = "span") {
    text_ = first_ ? "\n{\"name\":" : ",\n{\"name\":";
    first_ = false;
    append_json(text_, name);
    text_ += ",\"cat\":\"";
    text_ += category;
    text_ += "\",\"ph\":\"";
    text_ += phase;
    text_ += "\",\"pid\":";
    append_number(text_, process_);
    text_ += ",\"tid\":";
    append_number(text_, id);
  }

  void append_stamp(MonotonicTime time) {
    text_ += ",\"ts\":";
    append_microseconds(text_, time - start_);
  }

  WholeFile file_;
  MonotonicTime start_;
  MonotonicTime end_{};
  int process_;
  bool first_ = true;
  std::string text_;  // of the event being written
};

}  // namespace

void write_trace_json(const std::filesystem::path& file, MonotonicTime start,
                      const std::vector<const TraceBuffer*>& buffers) {
  TraceJson(file, start).write(buffers);
}

}  // namespace maploop::runtime
