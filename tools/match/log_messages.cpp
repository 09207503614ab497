#include "tools/match/log_messages.h"

#include <fstream>
#include <string_view>

#include "msgs/lcm/log/log_reader.h"

namespace maploop::match {

using lcm_log::LogReader;

bool is_lcm_log(const std::filesystem::path& file) {
  constexpr std::string_view sync = "\xed\xa1\xda\x01";
  std::string begin(sync.size(), '\0');
  std::ifstream(file, std::ios::binary).read(begin.data(), std::ssize(begin));
  return begin == sync || file.string().ends_with(".lcmlog.gz");
}

void visit_log(const std::filesystem::path& file,
               const std::function<void(const lcm_log::LogEvent&)>& visit) {
  LogReader reader(file, schema::own_schema());
  for (auto item = reader.next(); item != LogReader::Item::end; item = reader.next()) {
    if (item == LogReader::Item::damage)
      throw std::runtime_error(
          file.string() + " is damaged at byte " + std::to_string(reader.damage().begin) + " (" +
          reader.damage().reason + "); 'maploop log recover' makes a sound one of it");
    visit(reader.event());
  }
}

}  // namespace maploop::match
