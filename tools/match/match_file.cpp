#include "tools/match/match_file.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>

#include "msgs/lcm/channel_names.h"
#include "tools/evaluate/text_file.h"
#include "tools/match/cells.h"
#include "tools/match/log_messages.h"

namespace maploop::match {
namespace {

class MatchFileReader {
 public:
  explicit MatchFileReader(const std::filesystem::path& file) : file_(file) {}

  std::vector<TimedMatch> read() {
    const std::string text = evaluation::read_text(file_);
    std::vector<TimedMatch> matches;
    std::string_view rest = text;
    while (!rest.empty()) {
      const auto end = rest.find('\n');
      const auto cells = split(rest.substr(0, end), ',');
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
      ++line_;
      if (cells.size() > input_limits::columns)
        fail("more than " + std::to_string(input_limits::columns) + " columns");
      if (line_ == 1) {
        find_columns(cells);
      } else if (cells.size() > 1) {
        add(cells, matches);
      }
    }
    if (line_ == 0) fail("the file is empty");
    return matches;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ":" + std::to_string(std::max(line_, 1)) + ": " +
                             what);
  }

  void find_columns(const std::vector<std::string_view>& names) {
    const auto column = [&](std::string_view name) {
      const auto found = std::find(names.begin(), names.end(), name);
      return found == names.end() ? none : static_cast<std::size_t>(found - names.begin());
    };
    time_ = column("t");
    way_ = column("way_id");
    probability_ = column("p_link");
    node_a_ = column("node_a");
    node_b_ = column("node_b");
    if (time_ == none || way_ == none)
      fail("no columns t and way_id; is it a file of 'maploop match --csv'?");
  }

  template <class T>
  T number(const std::vector<std::string_view>& cells, std::size_t column) const {
    if (column >= cells.size()) fail("a column is missing");
    T value{};
    const std::string_view text = cells[column];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
      fail("'" + std::string(text) + "' is not a number");
    return value;
  }

  void add(const std::vector<std::string_view>& cells, std::vector<TimedMatch>& matches) const {
    MatchedFix matched;
    if (way_ >= cells.size()) fail("a column is missing");
    if (!cells[way_].empty()) {
      matched.way_id = number<std::int64_t>(cells, way_);
      matched.p_link = probability_ == none ? 1.0 : number<double>(cells, probability_);
      if (node_a_ != none && node_b_ != none) {
        matched.node_a = number<std::int64_t>(cells, node_a_);
        matched.node_b = number<std::int64_t>(cells, node_b_);
      }
      if (!(matched.p_link >= 0.0 && matched.p_link <= 1.0)) fail("p_link is not from 0 to 1");
    }
    try {
      matches.push_back({Time(checked_seconds(number<double>(cells, time_))), matched});
    } catch (const std::invalid_argument& e) {
      fail(e.what());
    }
  }

  std::filesystem::path file_;
  int line_ = 0;
  std::size_t time_ = none, way_ = none, node_a_ = none, node_b_ = none, probability_ = none;
};

std::vector<TimedMatch> read_log(const std::filesystem::path& file) {
  std::vector<TimedMatch> matches;
  visit_log(file, [&](const lcm_log::LogEvent& event) {
    if (event.channel != channel_names::map_match) return;
    matches.push_back(timed_match(decoded<maploop_lcm::map_match_t>(event, file)));
  });
  if (matches.empty())
    throw std::runtime_error(file.string() +
                             " holds no MAP_MATCH; was it recorded with 'maploop replay --map'?");
  return matches;
}

}  // namespace

std::vector<TimedMatch> read_matches(const std::filesystem::path& file) {
  return is_lcm_log(file) ? read_log(file) : MatchFileReader(file).read();
}

}  // namespace maploop::match
