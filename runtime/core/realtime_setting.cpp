#include "runtime/core/realtime_setting.h"

#include <fmt/format.h>

#include <algorithm>

namespace maploop::runtime {

bool RealtimeReport::all_granted() const {
  return std::all_of(settings.begin(), settings.end(),
                     [](const auto& s) { return s.verdict == Verdict::granted; });
}

const RealtimeSetting* RealtimeReport::find(std::string_view name) const {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [name](const auto& setting) { return setting.name == name; });
  return found == settings.end() ? nullptr : &*found;
}

std::string to_text(const RealtimeReport& report) {
  std::size_t width = 0;
  for (const RealtimeSetting& s : report.settings) width = std::max(width, s.name.size());
  std::string text;
  for (const RealtimeSetting& s : report.settings) {
    text += fmt::format("{:10}{:{}}{}", to_string(s.verdict), s.name, width + 2, s.granted);
    if (s.verdict != Verdict::granted) text += fmt::format(" (wanted: {})", s.asked);
    text += '\n';
    if (!s.reason.empty()) text += fmt::format("{:10}why: {}\n", "", s.reason);
    if (!s.remedy.empty()) text += fmt::format("{:10}remedy: {}\n", "", s.remedy);
  }
  return text;
}

std::string to_sentence(const RealtimeSetting& s) {
  return fmt::format("{} is {}, not {}: {}; {}", s.name, s.granted, s.asked, s.reason, s.remedy);
}

std::string to_short_text(const RealtimeReport& report) {
  std::string lines;
  std::size_t granted = 0;
  for (const RealtimeSetting& s : report.settings) {
    if (s.verdict == Verdict::granted) {
      ++granted;
    } else {
      lines += fmt::format("  {:10}{}: {}, not {}; {}\n", to_string(s.verdict), s.name, s.granted,
                           s.asked, s.remedy);
    }
  }
  return fmt::format("Real time: {} of {} settings granted\n{}", granted, report.settings.size(),
                     lines);
}

}  // namespace maploop::runtime
