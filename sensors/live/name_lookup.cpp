#include "sensors/live/name_lookup.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <system_error>
#include <thread>

namespace maploop::sensors {

struct NameLookup::Shared {
  Answer answer;  // constant once `known` is true
  std::atomic<bool> known{false};
};

namespace {

NameLookup::Answer ask_for(const std::string& host) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), nullptr, &wanted, &found);
  if (error != 0) return {{}, "has no address: " + std::string(gai_strerror(error))};
  std::array<char, INET_ADDRSTRLEN> text{};
  const auto* address = reinterpret_cast<const sockaddr_in*>(found->ai_addr);
  inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
  freeaddrinfo(found);
  return {text.data(), {}};
}

}  // namespace

NameLookup::NameLookup(const std::string& host) : shared_(std::make_shared<Shared>()) {
  in_addr numeric{};
  if (inet_pton(AF_INET, host.c_str(), &numeric) == 1) {
    shared_->answer.address = host;
    shared_->known = true;
    return;
  }
  try {
    std::thread([host, shared = shared_] {
      shared->answer = ask_for(host);
      shared->known = true;
    }).detach();
  } catch (const std::system_error& e) {
    shared_->answer.problem = std::string("cannot be looked up: ") + e.what();
    shared_->known = true;
  }
}

std::optional<NameLookup::Answer> NameLookup::answer() const {
  if (!shared_->known) return {};
  return shared_->answer;
}

}  // namespace maploop::sensors
