#include "tools/dashboard/message_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

#include "msgs/base64.h"

namespace maploop::dashboard {
namespace {

using nlohmann::json;
using schema::Kind;

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

// Returns the numbers of an array from its dimension number `at` on.
json numbers(const schema::Field& array, std::size_t at, std::size_t& index) {
  if (at == array.sizes.size()) return number(array.value(index++));
  json list = json::array();
  for (std::size_t i = 0; i < array.sizes[at]; ++i) list.push_back(numbers(array, at + 1, index));
  return list;
}

json tree(const schema::Field& field) {
  if (!field.sizes.empty() && field.member->kind == Kind::byte) return base64(field.data);
  if (!field.sizes.empty() && field.member->kind < Kind::string) {
    std::size_t index = 0;
    return numbers(field, 0, index);
  }
  if (field.count() == 1) return number(field.value());
  json all = field.sizes.empty() ? json::object() : json::array();
  for (const schema::Field& inner : field.inner) {
    if (all.is_array()) {
      all.push_back(tree(inner));
    } else if (inner.member->type_name != left_out) {
      all[inner.name()] = tree(inner);
    }
  }
  return all;
}

}  // namespace

std::string to_json(const schema::Field& message) {
  return tree(message).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace maploop::dashboard
