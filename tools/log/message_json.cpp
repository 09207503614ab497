#include "tools/log/message_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

#include "msgs/base64.h"

namespace maploop::lcm_log {
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

json schema_of(const schema::Type& type);

json schema_of(const schema::Member& member) {
  const auto of_one = [&]() -> json {
    if (member.type != nullptr) return schema_of(*member.type);
    if (member.kind == Kind::string) return {{"type", "string"}};
    if (member.kind == Kind::boolean) return {{"type", "boolean"}};
    const bool real = member.kind == Kind::float32 || member.kind == Kind::float64;
    return {{"type", real ? "number" : "integer"}};
  };
  if (!member.dimensions.empty() && member.kind == Kind::byte)
    return {{"type", "string"}, {"contentEncoding", "base64"}};
  json schema = of_one();
  for (std::size_t i = 0; i < member.dimensions.size(); ++i)
    schema = {{"type", "array"}, {"items", std::move(schema)}};
  return schema;
}

json schema_of(const schema::Type& type) {
  json properties = json::object();
  for (const schema::Member& member : type.members)
    if (member.type_name != left_out) properties[member.name] = schema_of(member);
  return {{"type", "object"}, {"title", type.name}, {"properties", std::move(properties)}};
}

}  // namespace

std::string json_schema(const schema::Type& type) {
  return schema_of(type).dump();
}

std::string to_json(const schema::Field& message) {
  return tree(message).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace maploop::lcm_log
