// Reads matches from a file, for scoring.
#include <stdexcept>

#include "tools/evaluate/log_messages.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/text_lines.h"
#include "tools/match/match_score.h"

namespace maploop::match {

std::vector<TimedMatch> read_matches(const std::filesystem::path& file) {
  if (evaluation::is_lcm_log(file)) return read_log_matches(file);
  constexpr auto none = evaluation::NamedColumns::none;
  constexpr auto incomplete = "no columns t and way_id; is it a file of 'maploop match --csv'?";
  const std::string text = evaluation::read_text(file);
  evaluation::NamedColumns rows(text, file.string());
  const std::size_t time = rows.column("t", incomplete), way = rows.column("way_id", incomplete),
                    probability = rows.column("p_link"), a = rows.column("node_a"),
                    b = rows.column("node_b");
  std::vector<TimedMatch> matches;
  while (rows.next()) {
    MatchedFix matched;
    if (!rows.cell(way).empty()) {
      matched.way_id = rows.number<std::int64_t>(way);
      matched.p_link = probability == none ? 1.0 : rows.number<double>(probability);
      if (a != none && b != none) {
        matched.node_a = rows.number<std::int64_t>(a);
        matched.node_b = rows.number<std::int64_t>(b);
      }
      if (!(matched.p_link >= 0.0 && matched.p_link <= 1.0)) rows.fail("p_link is not from 0 to 1");
    }
    try {
      matches.push_back({Time(checked_seconds(rows.number<double>(time))), matched});
    } catch (const std::invalid_argument& e) {
      rows.fail(e.what());
    }
  }
  return matches;
}

}  // namespace maploop::match
