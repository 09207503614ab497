// This file parses the reply of an NTRIP caster and extracts the stream from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace maploop::sensors {

// Handles version 1 ("ICY 200 OK", then the stream) and version 2 (HTTP 1.1, chunked or not). One
// thread at a time; memory is that of the reply's head, which is limited.
class NtripReply {
 public:
  enum class State : std::uint8_t {
    head,    // the head is not complete yet
    stream,  // the stream is being received
    ended,   // the caster has ended the stream
    refused  // problem() states why
  };

  // Takes bytes off `from`, and copies those of the stream to `to`; returns how many. Call again
  // while `from` is not empty; in the states `ended` and `refused` all bytes are taken and none
  // copied.
  std::size_t take(std::span<const std::uint8_t>& from, std::span<std::uint8_t> to);

  State state() const { return state_; }
  const std::string& problem() const { return problem_; }

 private:
  enum class Chunk : std::uint8_t { size, data, end };

  void take_head(std::span<const std::uint8_t>& from);
  void judge_head();
  void take_size(std::uint8_t c);
  void refuse(std::string problem);

  State state_ = State::head;
  std::string head_;
  std::string problem_;
  bool chunked_ = false;
  Chunk chunk_ = Chunk::size;
  std::uint64_t left_ = 0;       // bytes left of a chunk
  std::size_t size_digits_ = 0;  // digits of its length
  std::size_t size_line_ = 0;    // bytes of the line with the length
  bool extension_ = false;       // inside the extension after the length
};

}  // namespace maploop::sensors
