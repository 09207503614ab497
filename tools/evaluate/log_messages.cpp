#include "tools/evaluate/log_messages.h"

#include <fstream>
#include <string_view>

#include "sensors/replay/log_events.h"

namespace maploop::evaluation {

bool is_lcm_log(const std::filesystem::path& file) {
  constexpr std::string_view sync = "\xed\xa1\xda\x01";
  std::string begin(sync.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), std::ssize(begin));
  return begin == sync || file.string().ends_with(".lcmlog.gz") || sensors::is_own_recording(file);
}

void visit_log(const std::filesystem::path& file,
               const std::function<void(const lcm_log::LogEvent&)>& visit) {
  const auto log = sensors::open_log(file, schema::own_schema());
  for (auto item = log->next(); item != sensors::LogEvents::Item::end; item = log->next()) {
    if (item == sensors::LogEvents::Item::damage) {
      throw std::runtime_error(file.string() + " is damaged at byte " +
                               std::to_string(log->damage().begin) + " (" + log->damage().reason +
                               "); 'maploop log recover' makes a sound one of it");
    }
    visit(log->event());
  }
}

}  // namespace maploop::evaluation
