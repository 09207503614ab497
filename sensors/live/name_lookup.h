// This file looks up the address of a host's name without blocking.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace maploop::sensors {

// Numeric addresses are known at once. A name is looked up on a separate thread, which may take
// seconds and is never waited for. One thread at a time.
class NameLookup {
 public:
  explicit NameLookup(const std::string& host);

  // The answer is empty while it is not known yet.
  struct Answer {
    std::string address;  // numeric IPv4
    std::string problem;  // set if the address is missing
  };
  std::optional<Answer> answer() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace maploop::sensors
