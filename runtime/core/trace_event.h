// This file defines the parts of a trace: names, flows from thread to thread, and recorded events.
#pragma once

#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "msgs/time.h"

namespace maploop::runtime {

// This is a name that outlives the trace: a string literal, or a result of Tracer::name(). Anything
// else does not compile, so that recording keeps a pointer and copies nothing.
class TraceName {
 public:
  consteval TraceName(const char* literal) : text_(literal) {
    if (literal == nullptr) throw std::invalid_argument("trace: a name is missing");
  }
  const char* text() const { return text_; }

 private:
  friend class Tracer;
  struct Owned {
    const char* text;
  };
  explicit TraceName(Owned owned) : text_(owned.text) {}

  const char* text_;
};

// Hashes the source by FNV-1a (Fowler, Noll, Vo), then mixes in the sequence number by the
// finalizer of SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators",
// OOPSLA 2014): two sequence numbers of one source never have the same id.
constexpr std::uint64_t flow_id(std::string_view source, std::uint64_t sequence) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : source) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  hash += sequence * 0x9e3779b97f4a7c15u;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebu;
  return hash ^ (hash >> 31);
}

// Identifies one sample on its path through the threads: source and sequence number are the same on
// every thread.
struct TraceFlow {
  TraceName source;  // such as "camera"
  std::uint64_t sequence = 0;
};

// This is one slot of a buffer: half a cache line.
struct TraceEvent {
  enum class Kind : std::uint64_t { span, instant, counter, flow_start, flow_step, flow_end };
  static constexpr std::int64_t open_payload = -1;  // payload of a span that has not ended

  const char* name = nullptr;  // for a flow, its source
  MonotonicTime time{};        // for a span, its start
  // Holds a span's duration in ns, stored when it ends, possibly while another thread reads; a
  // counter's value as the bits of a double; or a flow's sequence number.
  std::atomic<std::int64_t> payload{0};
  Kind kind = Kind::instant;
};
static_assert(sizeof(TraceEvent) == 32);

}  // namespace maploop::runtime
