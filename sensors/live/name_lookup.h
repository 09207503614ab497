// The address of a host's name, without waiting for it.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace maploop::sensors {

// Numeric addresses are known at once. A name is asked for on a thread of its own, which the answer
// may take seconds to come to, and which nobody waits for. One thread at a time.
class NameLookup {
 public:
  explicit NameLookup(const std::string& host);

  // Nothing: not known yet.
  struct Answer {
    std::string address;  // numeric IPv4
    std::string problem;  // where there is none
  };
  std::optional<Answer> answer() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace maploop::sensors
