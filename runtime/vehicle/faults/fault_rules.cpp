#include "runtime/vehicle/faults/fault_rules.h"

#include <fmt/format.h>

#include <cstddef>

namespace maploop::vehicle {
namespace {

// Every kind has a rule, and the rules of one kind stand together.
constexpr bool in_order() {
  std::size_t kind = 0;
  for (const FaultRule& rule : fault_rules::all) {
    const auto own = static_cast<std::size_t>(rule.kind);
    if (own != kind && own != kind + 1) return false;
    kind = own;
  }
  return kind == static_cast<std::size_t>(FaultKind::hog);
}
static_assert(in_order());

std::string by_of(const FaultRule& rule) {
  if (rule.largest_by <= 0.0) return {};
  if (rule.unit == "1") return fmt::format("{}", rule.default_by);
  return fmt::format("{} {}", rule.default_by, rule.unit);
}

}  // namespace

std::string fault_kinds() {
  std::string all;
  std::string_view last;
  for (const FaultRule& rule : fault_rules::all) {
    if (rule.name != last) all.append(all.empty() ? "" : ", ").append(rule.name);
    last = rule.name;
  }
  return all;
}

std::string fault_page() {
  std::string page =
      "# Faults\n\n"
      "Made from the table in `faults/fault_rules.h`; a test compares them. A fault is written\n"
      "`KIND@TARGET[:START[:LENGTH]][,key=value...]`\n"
      "([how](../../tools/README.md#faults)). `by` is never 0; where it may be negative, the\n"
      "largest has a sign. What grows counts from the first sample that is struck.\n\n"
      "| kind | targets | `by` | largest | what it does |\n|---|---|---|---|---|\n";
  for (const FaultRule& rule : fault_rules::all) {
    std::string targets;
    for (const FaultTarget target : rule.targets)
      targets.append(targets.empty() ? "" : ", ").append(target_name(target));
    const std::string largest =
        rule.largest_by > 0.0 ? fmt::format("{}{:g}", rule.signed_by ? "+-" : "", rule.largest_by)
                              : std::string();
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", rule.name, targets, by_of(rule), largest,
                        rule.what);
  }
  return page;
}

}  // namespace maploop::vehicle
