#include "runtime/core/realtime_setting.h"

#include <algorithm>

namespace maploop::runtime {
namespace {

std::string padded(std::string_view text, std::size_t width) {
  std::string result(text);
  result.resize(std::max(width, result.size()), ' ');
  return result;
}

}  // namespace

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
  for (const RealtimeSetting& setting : report.settings) {
    width = std::max(width, setting.name.size());
  }
  const std::string indent(10, ' ');
  std::string text;
  for (const RealtimeSetting& s : report.settings) {
    text += padded(to_string(s.verdict), 10) + padded(s.name, width + 2) + s.granted;
    if (s.verdict != Verdict::granted) text += " (wanted: " + s.asked + ")";
    text += '\n';
    if (!s.reason.empty()) text += indent + "why: " + s.reason + '\n';
    if (!s.remedy.empty()) text += indent + "remedy: " + s.remedy + '\n';
  }
  return text;
}

std::string to_sentence(const RealtimeSetting& s) {
  return s.name + " is " + s.granted + ", not " + s.asked + ": " + s.reason + "; " + s.remedy;
}

std::string to_short_text(const RealtimeReport& report) {
  const auto granted = std::count_if(report.settings.begin(), report.settings.end(),
                                     [](const auto& s) { return s.verdict == Verdict::granted; });
  std::string text = "Real time: " + std::to_string(granted) + " of " +
                     std::to_string(report.settings.size()) + " settings granted\n";
  for (const RealtimeSetting& s : report.settings) {
    if (s.verdict == Verdict::granted) continue;
    text += "  " + padded(to_string(s.verdict), 10) + s.name + ": " + s.granted + ", not " +
            s.asked + "; " + s.remedy + '\n';
  }
  return text;
}

}  // namespace maploop::runtime
