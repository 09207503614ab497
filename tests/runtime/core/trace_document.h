// This file reads a written trace back with another library.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/trace.h"
#include "tests/support/real_data.h"

namespace maploop::runtime {

class TraceDocument {
 public:
  explicit TraceDocument(const Tracer& tracer) {
    const maploop::testing::TemporaryFolder folder;
    tracer.write(folder.path() / "trace.json");
    std::ifstream file(folder.path() / "trace.json");
    json_ = nlohmann::json::parse(file);
  }

  const nlohmann::json& json() const { return json_; }
  const nlohmann::json& other() const { return json_.at("otherData"); }

  // Returns the events of a phase ("X", "i", ...) in the file's order.
  std::vector<nlohmann::json> events(std::string_view phase) const {
    std::vector<nlohmann::json> found;
    for (const auto& event : json_.at("traceEvents")) {
      if (event.at("ph") == phase) found.push_back(event);
    }
    return found;
  }

  // Returns the only event of that name.
  nlohmann::json event(std::string_view name) const {
    std::vector<nlohmann::json> found;
    for (const auto& event : json_.at("traceEvents")) {
      if (event.at("name") == name) found.push_back(event);
    }
    return found.size() == 1 ? found.front() : nlohmann::json();
  }

 private:
  nlohmann::json json_;
};

// These are in nanoseconds and exact, because the file has three decimals of a microsecond.
inline std::int64_t start_of(const nlohmann::json& event) {
  return std::llround(event.at("ts").get<double>() * 1000.0);
}
inline std::int64_t end_of(const nlohmann::json& event) {
  return start_of(event) + std::llround(event.at("dur").get<double>() * 1000.0);
}

}  // namespace maploop::runtime
