#include "sensors/live/ntrip_reply.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace maploop::sensors {
namespace {

constexpr std::size_t longest_head = 8192;

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Returns a line as it can be shown to a user.
std::string shown(const std::string& line) {
  std::string text = line.substr(0, 80);
  std::erase_if(text, [](char c) { return c < ' ' || c > '~'; });
  return "'" + text + "'";
}

}  // namespace

void NtripReply::refuse(std::string problem) {
  state_ = State::refused;
  problem_ = std::move(problem);
}

void NtripReply::take_head(std::span<const std::uint8_t>& from) {
  while (!from.empty() && state_ == State::head) {
    head_ += static_cast<char>(from.front());
    from = from.subspan(1);
    const bool first_line = head_.find('\n') == head_.size() - 1;
    // The head of version 1 is only its first line.
    if (first_line && head_.ends_with("\r\n") && head_.starts_with("ICY 200 OK")) {
      state_ = State::stream;
    } else if (head_.ends_with("\r\n\r\n") || (first_line && !head_.starts_with("HTTP/"))) {
      judge_head();
    } else if (head_.size() >= longest_head) {
      refuse("answers with a header that does not end; is it an NTRIP caster?");
    }
  }
}

void NtripReply::judge_head() {
  const std::string line = head_.substr(0, head_.find_first_of("\r\n"));
  const std::string head = lower_case(head_);
  const bool http = line.starts_with("HTTP/1.");
  if (line.starts_with("SOURCETABLE") || head.find("gnss/sourcetable") != std::string::npos) {
    refuse("answers with its source table, so it does not have this mountpoint");
  } else if (line.starts_with("ERROR")) {
    refuse("refuses: " + shown(line) + "; are user, password and mountpoint right?");
  } else if (http && line.size() >= 12 && line.substr(9, 3) == "401") {
    refuse("refuses the user and password (401)");
  } else if (http && line.size() >= 12 && line.substr(9, 3) == "404") {
    refuse("does not have this mountpoint (404)");
  } else if (http && line.size() >= 12 && line.substr(9, 3) == "200") {
    state_ = State::stream;
    chunked_ = head.find("transfer-encoding: chunked") != std::string::npos ||
               head.find("transfer-encoding:chunked") != std::string::npos;
  } else {
    refuse("answers " + shown(line) + (http ? "" : "; is it an NTRIP caster?"));
  }
}

// Parses the line with a chunk's length, such as "1f;extension\r\n".
void NtripReply::take_size(std::uint8_t c) {
  constexpr std::size_t longest_line = 256, max_digits = 8;
  if (c == '\n') {
    if (size_digits_ == 0) return refuse("sends a chunk without a length");
    chunk_ = left_ > 0 ? Chunk::data : Chunk::size;
    if (left_ == 0) state_ = State::ended;
    size_digits_ = size_line_ = 0;
    extension_ = false;
    return;
  }
  if (++size_line_ > longest_line) return refuse("sends a chunk whose length has no end");
  if (c == '\r' || extension_) return;
  if (c == ';' || c == ' ') {
    extension_ = true;
    return;
  }
  if (std::isxdigit(c) == 0 || ++size_digits_ > max_digits) {
    return refuse("sends a chunk whose length is not a number");
  }
  const int digit = std::isdigit(c) != 0 ? c - '0' : std::tolower(c) - 'a' + 10;
  left_ = 16 * left_ + static_cast<std::uint64_t>(digit);
}

std::size_t NtripReply::take(std::span<const std::uint8_t>& from, std::span<std::uint8_t> to) {
  if (state_ == State::head) take_head(from);
  std::size_t copied = 0;
  const auto copy = [&](std::size_t most) {
    const std::size_t size = std::min({most, from.size(), to.size() - copied});
    std::copy_n(from.begin(), size, to.begin() + static_cast<std::ptrdiff_t>(copied));
    from = from.subspan(size);
    copied += size;
    return size;
  };
  while (!from.empty() && state_ == State::stream && copied < to.size()) {
    if (!chunked_) {
      copy(from.size());
    } else if (chunk_ == Chunk::data) {
      left_ -= copy(left_);
      if (left_ == 0) chunk_ = Chunk::end;
    } else {
      const std::uint8_t c = from.front();
      from = from.subspan(1);
      if (chunk_ == Chunk::size) {
        take_size(c);
      } else if (c == '\n') {
        chunk_ = Chunk::size;
      } else if (c != '\r') {
        refuse("sends a chunk that is longer than its stated length");
      }
    }
  }
  if (state_ == State::ended || state_ == State::refused) from = {};
  return copied;
}

}  // namespace maploop::sensors
