#include "tools/dashboard/message_json.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <variant>

#include "msgs/base64.h"

namespace maploop::dashboard {
namespace {

using nlohmann::json;

constexpr std::string_view left_out = "maploop_lcm.histogram_t";

json number(const schema::Value& value) {
  return std::visit(
      [](const auto& v) -> json {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_floating_point_v<T>) {
          return std::isfinite(v) ? json(v) : json(nullptr);
        } else {
          return json(v);
        }
      },
      value);
}

// Returns the numbers of an array; `sizes` are outermost first.
json numbers(const schema::DecodedMessage& message, std::size_t node,
             std::span<const std::uint32_t> sizes, std::uint32_t& index) {
  json list = json::array();
  for (std::uint32_t i = 0; i < sizes[0]; ++i) {
    list.push_back(sizes.size() == 1 ? number(message.value(node, index++))
                                     : numbers(message, node, sizes.subspan(1), index));
  }
  return list;
}

json tree(const schema::DecodedMessage& message, std::size_t node) {
  const auto nodes = message.nodes();
  const schema::Node& n = nodes[node];
  const bool structure = n.member == nullptr || n.member->kind == schema::Kind::structure;
  const auto for_each_below = [&](const auto& act) {
    for (std::size_t below = node + 1; below < n.end; below = nodes[below].end) act(below);
  };
  if (const auto sizes = message.sizes(node); !sizes.empty()) {
    if (n.member->kind == schema::Kind::byte) {
      return base64(n.count > 0 ? std::span(message.encoded(node).data(), n.count)
                                : std::span<const std::uint8_t>());
    }
    if (!structure && n.member->kind != schema::Kind::string) {
      std::uint32_t index = 0;
      return numbers(message, node, sizes, index);
    }
    json list = json::array();
    for_each_below([&](std::size_t below) { list.push_back(tree(message, below)); });
    return list;
  }
  if (!structure) return number(message.value(node));
  json members = json::object();
  for_each_below([&](std::size_t below) {
    const schema::Member& member = *nodes[below].member;
    if (member.type_name != left_out) members[member.name] = tree(message, below);
  });
  return members;
}

}  // namespace

std::string to_json(const schema::DecodedMessage& message) {
  return tree(message, 0).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace maploop::dashboard
