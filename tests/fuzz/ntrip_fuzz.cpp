// What a caster answers, in pieces; and addresses of mountpoints.
#include <array>
#include <stdexcept>
#include <string_view>

#include "sensors/live/ntrip_reply.h"
#include "sensors/live/ntrip_request.h"
#include "tests/fuzz/fuzz_input.h"

using namespace maploop;
using namespace maploop::sensors;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  NtripReply reply;
  std::array<std::uint8_t, 16> to{};
  std::size_t copied = 0;
  while (!input.empty()) {
    auto from = input.bytes(1 + input.byte() % 64);
    while (!from.empty()) {
      const std::size_t before = from.size();
      copied += reply.take(from, to);
      fuzz::require(from.size() < before || reply.state() != NtripReply::State::head);
    }
  }
  fuzz::require(copied <= size);
  fuzz::require((reply.state() == NtripReply::State::refused) == !reply.problem().empty());
  try {
    const NtripAddress address =
        parse_ntrip("ntrip://" + std::string(reinterpret_cast<const char*>(data), size));
    const std::string request = ntrip_request(address, {});
    fuzz::require(request.find("\r\n\r\n") == request.size() - 4);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
