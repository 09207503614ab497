#include "sensors/live/ntrip_client.h"

#include <arpa/inet.h>
#include <netdb.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "sensors/clock/host_clock.h"
#include "sensors/live/tls_connection.h"

namespace maploop::sensors {
namespace {

using std::chrono::seconds;

constexpr Duration first_pause = seconds(1), longest_pause = seconds(60);
constexpr Duration longest_quiet = seconds(60);

MonotonicTime steady_now() {
  return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
}

Duration utc_of_day() {
  return HostClock().now().time_since_epoch() % std::chrono::hours(24);
}

}  // namespace

// Numeric addresses are known at once. A name is looked up on a separate thread, which may take
// seconds.
std::future<NtripClient::Host> NtripClient::look_up(const std::string& name) {
  std::promise<Host> known;
  std::future<Host> answer = known.get_future();
  in_addr numeric{};
  if (inet_pton(AF_INET, name.c_str(), &numeric) == 1) {
    known.set_value({name, {}});
    return answer;
  }
  try {
    std::thread([name, asked = std::move(known)]() mutable {
      addrinfo wanted{};
      wanted.ai_family = AF_INET;
      wanted.ai_socktype = SOCK_STREAM;
      addrinfo* found = nullptr;
      const int error = getaddrinfo(name.c_str(), nullptr, &wanted, &found);
      if (error != 0) {
        asked.set_value({{}, "has no address: " + std::string(gai_strerror(error))});
        return;
      }
      std::array<char, INET_ADDRSTRLEN> text{};
      const auto* address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
      inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
      freeaddrinfo(found);
      asked.set_value({text.data(), {}});
    }).detach();
  } catch (const std::system_error& e) {
    known = {};
    answer = known.get_future();
    known.set_value({{}, std::string("cannot be looked up: ") + e.what()});
  }
  return answer;
}

void NtripClient::give_up(std::string problem) {
  pause_ = pause_ == Duration::zero() ? first_pause : std::min(2 * pause_, longest_pause);
  state_.open = false;
  state_.problem = std::move(problem);
  // The lookup is dropped too, because the name may have another address by then.
  connection_.reset();
  lookup_ = {};
  unread_ = {};
  greeted_ = 0;
  next_lookup_ = steady_now() + pause_;
}

bool NtripClient::find_host(Duration patience) {
  if (connection_) return true;
  const MonotonicTime now = steady_now();
  if (now < next_lookup_) {
    std::this_thread::sleep_for(std::min(patience, next_lookup_ - now));
    return false;
  }
  if (!lookup_.valid()) lookup_ = look_up(address_.host);
  if (lookup_.wait_for(patience) != std::future_status::ready) return false;
  const Host host = lookup_.get();
  if (!host.problem.empty()) {
    give_up("host '" + address_.host + "' " + host.problem);
    return false;
  }
  Endpoint endpoint = parse_endpoint("tcp://" + host.address + ":" + std::to_string(address_.port));
  if (address_.encrypted) {
    connection_ = std::make_unique<TlsConnection>(std::move(endpoint), address_.host);
  } else {
    connection_ = std::make_unique<Connection>(std::move(endpoint));
  }
  return true;
}

void NtripClient::greet() {
  greeted_ = connection_->state().opened;
  reply_ = {};
  heard_ = said_ = steady_now();
  if (!connection_->write(ntrip_request(address_, utc_of_day()))) {
    give_up("does not accept the request");
  }
}

void NtripClient::say_position() {
  const MonotonicTime now = steady_now();
  if (!address_.position || !state_.open || now - said_ < between_positions_) return;
  said_ = now;
  connection_->write(ntrip_gga(*address_.position, utc_of_day()));
}

std::size_t NtripClient::read(std::span<std::uint8_t> to, Duration patience) {
  const MonotonicTime end = steady_now() + patience;
  do {
    if (!find_host(end - steady_now())) continue;
    if (unread_.empty()) {
      const std::size_t size = connection_->read(buffer_, end - steady_now());
      unread_ = std::span(buffer_).first(size);
    }
    const ConnectionState& below = connection_->state();
    if (below.opened > greeted_ && below.open) {
      greet();
      continue;
    }
    if (!below.open && unread_.empty()) {
      // A connection without a problem is still being opened.
      if (!below.problem.empty()) give_up(below.problem);
      continue;
    }
    const std::size_t size = reply_.take(unread_, to);
    const NtripReply::State reply = reply_.state();
    const bool streams = reply == NtripReply::State::stream || reply == NtripReply::State::ended;
    if (streams && !state_.open) {
      state_.open = true;
      ++state_.opened;
      state_.problem.clear();
    }
    if (reply == NtripReply::State::refused) give_up(reply_.problem());
    if (reply == NtripReply::State::ended) give_up("has ended the stream");
    if (size > 0) {
      state_.bytes += size;
      pause_ = {};
      heard_ = steady_now();
      return size;
    }
    if (connection_ && steady_now() - heard_ > longest_quiet) {
      give_up("has been silent for a minute");
    }
    if (connection_) say_position();
  } while (steady_now() < end);
  return 0;
}

std::unique_ptr<ByteStream> open_stream(std::string_view text) {
  if (is_ntrip(text)) return std::make_unique<NtripClient>(parse_ntrip(text));
  return std::make_unique<Connection>(parse_endpoint(text));
}

}  // namespace maploop::sensors
