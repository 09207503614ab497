#include "tools/dashboard/foxglove_protocol.h"

#include <algorithm>

namespace maploop::dashboard::foxglove {

using nlohmann::json;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < sizeof number; ++i)
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return number;
}

std::optional<std::int64_t> integer(const json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end() || !found->is_number_integer()) return {};
  return found->get<std::int64_t>();
}

std::string text(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

const json& list(const json& object, const char* key) {
  static const json none = json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : none;
}

json server_info() {
  return {{"op", "serverInfo"},
          {"name", "maploop"},
          {"capabilities", {"services"}},
          {"supportedEncodings", {"json"}},
          {"metadata", json::object()}};
}

json services() {
  const json number{{"type", "number"}}, string{{"type", "string"}};
  const json request{{"type", "object"},
                     {"title", "replay control"},
                     {"properties", {{"run", string}, {"kind", string}, {"value", number}}},
                     {"required", {"run", "kind"}}};
  const json response{{"type", "object"}, {"title", "replay control answer"}};
  const auto described = [](const json& schema) {
    return json{{"encoding", "json"},
                {"schemaName", schema["title"]},
                {"schemaEncoding", "jsonschema"},
                {"schema", schema.dump()}};
  };
  return {{"op", "advertiseServices"},
          {"services",
           {{{"id", 1},
             {"name", "/replay/control"},
             {"type", "replay control"},
             {"request", described(request)},
             {"response", described(response)}}}}};
}

bool offers_protocol(std::string_view offered) {
  while (!offered.empty()) {
    const std::size_t comma = std::min(offered.find(','), offered.size());
    std::string_view name = offered.substr(0, comma);
    while (name.starts_with(' ')) name.remove_prefix(1);
    while (name.ends_with(' ')) name.remove_suffix(1);
    if (name == protocol) return true;
    offered.remove_prefix(std::min(comma + 1, offered.size()));
  }
  return false;
}

}  // namespace maploop::dashboard::foxglove
