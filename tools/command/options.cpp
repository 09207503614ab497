#include "tools/command/options.h"

#include <stdexcept>

#include "tools/command/option_checks.h"

namespace maploop::tools {

CLI::Option* add_lcm_url(CLI::App* sub, std::string& url) {
  return sub->add_option("--lcm-url", url,
                         std::string("Where LCM messages go; without it the configuration's "
                                     "lcm_url, else LCM_DEFAULT_URL of the environment, else ") +
                             vehicle::LcmBus::default_url);
}

CLI::Option* add_config(CLI::App* sub, std::filesystem::path& file, const char* what) {
  return sub->add_option("--config", file, what)->check(existing_file());
}

CLI::Option* add_settings(CLI::App* sub, std::vector<std::string>& settings) {
  return sub
      ->add_option(
          "--set", settings,
          "TABLE.KEY=VALUE of a parameter, such as fusion.use_gnss=false, in place of what "
          "--config says")
      ->allow_extra_args(false);
}

CLI::Option* add_topics(CLI::App* sub, std::vector<std::string>& topics) {
  return sub
      ->add_option("--topic", topics,
                   "SENSOR=TOPIC of a bag or an MCAP file, such as camera.left=/left/image_raw; "
                   "the topic none: the sensor is not used ([bag] topics)")
      ->allow_extra_args(false);
}

CLI::Option* add_output(CLI::App* sub, const char* flag, std::filesystem::path& file,
                        const char* what) {
  return sub->add_option(flag, file, what)->check(writable_file());
}

void set_map(vehicle::MapParameters& map, const std::filesystem::path& file,
             std::optional<vehicle::MapMode> mode) {
  if (!file.empty()) map.file = file.string();
  if (!mode) return;
  map.mode = *mode;
  if (map.mode != vehicle::MapMode::none && map.file.empty()) {
    throw std::runtime_error("--map-mode " + std::string(to_string(map.mode)) +
                             " needs a map: --map FILE");
  }
}

}  // namespace maploop::tools
