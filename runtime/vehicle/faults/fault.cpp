#include "runtime/vehicle/faults/fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "runtime/vehicle/faults/fault_rules.h"
#include "sensors/number.h"

namespace maploop::vehicle {
namespace {

constexpr std::array<std::string_view, 13> target_names{
    "camera", "velodyne", "imu", "gyro",   "accelerometer", "gnss", "wheel",
    "stereo", "lidar",    "ppp", "fusion", "mapmatch",      "cpu"};

template <class Names>
std::string listed(const Names& names) {
  std::string all;
  for (const std::string_view name : names) all.append(all.empty() ? "" : ", ").append(name);
  return all;
}

// Removes the text up to the first separator from `rest`, and returns it without the separator.
std::string_view cut(std::string_view& rest, char separator) {
  const std::size_t at = rest.find(separator);
  const std::string_view head = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view{} : rest.substr(at + 1);
  return head;
}

// A Parser makes a Fault of one fault's text; every error names the whole text.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Fault parse() {
    fault_.text = text_;
    std::string_view keys = text_;
    std::string_view place = cut(keys, ',');
    const bool has_keys = text_.find(',') != std::string_view::npos;
    kind_ = cut(place, '@');
    check_kind();
    parse_place(place);
    fault_.kind = rule_->kind;
    fault_.by = rule_->default_by;
    if (kind_is(FaultKind::hog)) fault_.threads = 2;
    for (bool more = has_keys; more;) {
      more = keys.find(',') != std::string_view::npos;
      parse_key(cut(keys, ','));
    }
    check_hog();
    return fault_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("fault '" + std::string(text_) + "': " + what);
  }

  bool kind_is(FaultKind kind) const { return fault_.kind == kind; }
  bool strikes_samples() const { return fault_.kind < FaultKind::slow; }

  void check_kind() const {
    for (const FaultRule& rule : fault_rules::all) {
      if (rule.name == kind_) return;
    }
    fail("'" + std::string(kind_) +
         "' is not a kind of fault; write KIND@TARGET[:START[:LENGTH]]"
         "[,key=value...] with one of the kinds " +
         fault_kinds());
  }

  void parse_place(std::string_view place) {
    const auto colons = std::count(place.begin(), place.end(), ':');
    parse_target(cut(place, ':'));
    if (colons > 2) fail("at most START and LENGTH follow the target");
    if (colons >= 1) {
      fault_.start = from_seconds(number("START", cut(place, ':'), 0.0, longest_drive));
    }
    if (colons == 2 && place != "end") {
      fault_.length = from_seconds(number("LENGTH ('end', or seconds)", place, 0.0, longest_drive));
      if (*fault_.length <= Duration::zero()) fail("LENGTH must be above 0 s");
    }
  }

  void parse_target(std::string_view name) {
    std::vector<std::string_view> allowed;
    for (const FaultRule& rule : fault_rules::all) {
      if (rule.name != kind_) continue;
      for (const FaultTarget target : rule.targets) {
        if (target_name(target) == name) {
          fault_.target = target;
          rule_ = &rule;
          return;
        }
        allowed.push_back(target_name(target));
      }
    }
    fail("'" + std::string(kind_) + "' cannot be applied to '" + std::string(name) +
         "'; it applies to " + listed(allowed));
  }

  void parse_key(std::string_view pair) {
    std::string_view value = pair;
    const std::string_view key = cut(value, '=');
    std::vector<std::string_view> allowed;
    if (rule_->largest_by > 0.0) allowed.push_back("by");
    if (strikes_samples()) allowed.insert(allowed.end(), {"share", "seed"});
    if (kind_is(FaultKind::hog)) allowed.push_back("threads");
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) {
      fail("'" + std::string(kind_) + "' has no key '" + std::string(key) + "'; it has " +
           listed(allowed));
    }
    if (std::find(seen_.begin(), seen_.end(), key) != seen_.end()) {
      fail("'" + std::string(key) + "' is given twice");
    }
    seen_.push_back(key);
    if (key == "by") {
      const double largest = rule_->largest_by;
      fault_.by = number("by", value, rule_->signed_by ? -largest : 0.0, largest);
      if (fault_.by == 0.0) fail("'by' must not be 0");
    } else if (key == "share") {
      fault_.share = number("share", value, 0.0, 1.0);
      if (fault_.share == 0.0) fail("'share' must be above 0");
    } else if (key == "seed") {
      fault_.seed = static_cast<std::uint64_t>(whole_number("seed", value, 0.0, 0x1p53));
    } else {
      fault_.threads = static_cast<int>(whole_number("threads", value, 1.0, 16.0));
    }
  }

  double number(std::string_view what, std::string_view text, double low, double high) const {
    const auto value = sensors::parse_number<double>(text);
    if (!value || *value < low || *value > high) {
      fail(fmt::format("{} must be a number from {} to {}, not '{}'", what, low, high, text));
    }
    return *value;
  }

  double whole_number(std::string_view what, std::string_view text, double low, double high) const {
    const double value = number(what, text, low, high);
    if (value != std::floor(value)) fail(std::string(what) + " must be a whole number");
    return value;
  }

  void check_hog() const {
    if (kind_is(FaultKind::hog) && (!fault_.length || *fault_.length > longest_hog)) {
      fail("'hog' needs START:LENGTH, and a LENGTH of at most 60 s");
    }
  }

  std::string_view text_;
  std::string_view kind_;
  const FaultRule* rule_ = nullptr;  // known once the target is
  std::vector<std::string_view> seen_;
  Fault fault_;
};

}  // namespace

std::string_view target_name(FaultTarget target) {
  return target_names[static_cast<std::size_t>(target)];
}

Fault parse_fault(std::string_view text) {
  return Parser(text).parse();
}

FaultWindow window(const Fault& fault, Time origin) {
  FaultWindow w;
  if (fault.start > Duration::zero()) w.begin = origin + fault.start;
  if (fault.length) w.end = origin + fault.start + *fault.length;
  return w;
}

}  // namespace maploop::vehicle
