// The option that names the LCM bus: the same for every command that uses it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "runtime/vehicle/output/lcm_bus.h"

namespace maploop::tools {

// `url` stays empty where the option is not given: vehicle::bus_url() says what holds then.
inline CLI::Option* add_lcm_url(CLI::App* sub, std::string& url) {
  return sub->add_option("--lcm-url", url,
                         std::string("Where LCM messages go; without it the configuration's "
                                     "lcm_url, else LCM_DEFAULT_URL of the environment, else ") +
                             vehicle::LcmBus::default_url);
}

}  // namespace maploop::tools
