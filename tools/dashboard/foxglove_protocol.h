// This file writes and reads the messages of the protocol of Foxglove's viewers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace maploop::dashboard::foxglove {

inline constexpr std::string_view protocol = "foxglove.websocket.v1";
// The first bytes of binary frames.
inline constexpr char message_data = 1, call_request = 2, call_response = 3;

// All numbers of the protocol are little-endian.
template <class Number>
void append(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i)
    bytes += static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * i));
}

// Precondition: there are four bytes.
std::uint32_t number_at(std::string_view bytes, std::size_t at);

// Return a member of a viewer's message; nothing, or an empty one, if it is not of that type.
std::optional<std::int64_t> integer(const nlohmann::json& object, const char* key);
std::string text(const nlohmann::json& object, const char* key);
const nlohmann::json& list(const nlohmann::json& object, const char* key);

// Return the messages that a server sends to a new viewer.
nlohmann::json server_info();
nlohmann::json services();

// Returns whether a list of protocols, separated by commas, has this one.
bool offers_protocol(std::string_view offered);

}  // namespace maploop::dashboard::foxglove
