#include "runtime/vehicle/vehicle_config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "runtime/core/config.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

const std::filesystem::path shipped = MAPLOOP_SHIPPED_CONFIG;

VehicleConfig load_text(const std::string& text) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "test.toml";
  std::ofstream(file) << text;
  return load_vehicle_config(file);
}

std::set<std::string> keys(const std::string& toml) {
  std::set<std::string> all;
  std::istringstream in(toml);
  std::string table;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('[')) table = line;
    const auto equals = line.find(" = ");
    if (!line.starts_with('#') && equals != std::string::npos) {
      all.insert(table + line.substr(0, equals));
    }
  }
  return all;
}

TEST(VehicleConfig, TheShippedFileHasEveryKeyWithItsDefault) {
  EXPECT_EQ(to_toml(load_vehicle_config(shipped)), to_toml(VehicleConfig{}));
  std::ostringstream text;
  text << std::ifstream(shipped).rdbuf();
  EXPECT_EQ(keys(text.str()), keys(to_toml(VehicleConfig{})));
}

TEST(VehicleConfig, WhatIsWrittenIsReadBack) {
  VehicleConfig config;
  config.lcm_url = "udpm://239.255.76.67:7667?ttl=1";
  config.fusion.gyro_noise = 1.0 / 3.0;
  config.stereo.bucket_size = 64;
  config.gnss.seed = 77;
  EXPECT_EQ(to_toml(load_text(to_toml(config))), to_toml(config));
  EXPECT_NE(to_toml(config), to_toml(VehicleConfig{}));
}

TEST(VehicleConfig, KeysThatAreAbsentKeepTheirDefaults) {
  const VehicleConfig config = load_text("[stereo]\nbucket_size = 40\n");
  VehicleConfig expected;
  expected.stereo.bucket_size = 40;
  EXPECT_EQ(to_toml(config), to_toml(expected));
}

TEST(VehicleConfig, AnUnknownTableIsAnError) {
  try {
    load_text("[sterio]\nbucket_size = 40\n");
    FAIL();
  } catch (const runtime::ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("sterio"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("test.toml:1"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace maploop::vehicle
