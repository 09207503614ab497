#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/analyze/analysis.h"
#include "tools/web/table.h"

namespace maploop::analyze {
namespace {

const web::Columns<Promise> columns{
    {"", "thread", -11, 0, &Promise::name},
    {"scheduling", "", -8, 0, &Promise::scheduling},
    {"period_ms", "period", 8, 1, &Promise::period},
    {"longest_execution_ms", "longest", 8, 3,
     [](const Promise& p) { return p.execution.observed; }},
    {"execution_bound_ms", "bound", 8, 3, [](const Promise& p) { return p.execution.bound; }},
    {"response_bound_ms", "response", 9, 3, &Promise::response},
    {"longest_response_ms", "measured", 9, 3, &Promise::measured},
    {"deadline_ms", "deadline", 8, 0,
     [](const Promise& p) { return p.deadline > 0.0 ? p.deadline : std::nan(""); }},
    {"tail/values", "", 0, 0, [](const Promise& p) { return p.execution.exceedances; }},
    {"tail/distance", "", 0, 0, [](const Promise& p) { return p.execution.distance; }},
    {"tail/used", "", 0, 0, [](const Promise& p) { return p.execution.fitted; }},
    {"kept", "", 0, 0, [](const Promise& p) { return p.kept(); }},
};

}  // namespace

std::string to_text(const Analysis& a) {
  std::string text = fmt::format(
      "{} CPUs, {:.0f} % of them for threads that go first. Wake-up up to {:.3f} ms. In ms:\n"
      "                       each     execution   release to result\n{}\n",
      a.cpus, 100.0 * a.utilization, a.blocking, web::heading_text(columns));
  for (const Promise& p : a.threads) text += web::to_text(columns, p) + '\n';
  text += "bound: of the fitted tail, or of the longest with a margin (not used):\n";
  for (const Promise& p : a.threads) {
    text += fmt::format("  {:<11} {} values in the tail, {:.2f} from the fitted one{}\n", p.name,
                        p.execution.exceedances, p.execution.distance,
                        p.execution.fitted ? "" : ": not used");
  }
  if (a.advice.empty()) return text + "Every deadline can be promised, as far as this run shows.\n";
  for (const std::string& sentence : a.advice) text += sentence + '\n';
  return text;
}

nlohmann::json to_json(const Analysis& a) {
  return {{"cpus", a.cpus},
          {"wake_up_ms", a.blocking},
          {"utilization", a.utilization},
          {"threads", web::by_name(columns, a.threads)},
          {"advice", a.advice}};
}

}  // namespace maploop::analyze
