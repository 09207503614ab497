#include "tools/match/score_output.h"

#include <fmt/format.h>

namespace maploop::match {
namespace {

nlohmann::json to_json(const Tally& t) {
  return {{"fixes", t.fixes}, {"right", t.share()}, {"coverage", t.coverage()}};
}

std::string line(const char* what, const Tally& t) {
  return fmt::format("  right way, {:10} {:7.2f} % of {} fixes, coverage {:.2f} %\n", what,
                     100.0 * t.share(), t.fixes, 100.0 * t.coverage());
}

}  // namespace

std::string to_text(const MatchScore& score) {
  return line("all labels", score.all) + line("conf = 1", score.certain);
}

std::string to_text(const Reliability& r) {
  std::string text = "  P(link) said, mean -> share on the right way (fixes)\n";
  for (std::size_t k = 0; k < r.fixes.size(); ++k) {
    if (r.fixes[k] == 0) continue;
    const auto n = static_cast<double>(r.fixes[k]);
    text += fmt::format("  {:.1f} to {:.1f}: {:.3f} -> {:.3f} ({})\n", 0.1 * static_cast<double>(k),
                        0.1 * static_cast<double>(k + 1), r.p_sum[k] / n,
                        static_cast<double>(r.right[k]) / n, r.fixes[k]);
  }
  return text;
}

nlohmann::json to_json(const MatchScore& score) {
  nlohmann::json reliability = nlohmann::json::array();
  const Reliability& r = score.reliability;
  for (std::size_t k = 0; k < r.fixes.size(); ++k) {
    if (r.fixes[k] == 0) continue;
    const auto n = static_cast<double>(r.fixes[k]);
    reliability.push_back({{"p_said", r.p_sum[k] / n},
                           {"right", static_cast<double>(r.right[k]) / n},
                           {"fixes", r.fixes[k]}});
  }
  return {{"all", to_json(score.all)},
          {"certain", to_json(score.certain)},
          {"reliability", reliability}};
}

}  // namespace maploop::match
