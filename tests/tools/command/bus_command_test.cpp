// Tests which LCM bus the commands use.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using testing::maploop_command;

// Each command that uses the bus is ended by a bus that LCM cannot open: its error names the URL
// that it was about to use.
class EachBusCommand : public ::testing::TestWithParam<std::vector<std::string>> {
 protected:
  std::string said(const std::string& environment, const std::vector<std::string>& options) const {
    std::vector<std::string> command{"env", "LCM_DEFAULT_URL=" + environment, maploop_command()};
    command.insert(command.end(), GetParam().begin(), GetParam().end());
    if (takes_drive()) command.push_back(testing::drive_0013().string());
    if (GetParam()[0] == "live") command.push_back(write_config().string());
    command.insert(command.end(), options.begin(), options.end());
    const testing::ProcessResult result = testing::run(command);
    return result.out + result.error;
  }

  bool takes_drive() const { return GetParam()[0] == "replay"; }

  std::filesystem::path write_config() const {
    const auto file = folder_.path() / "live.toml";
    std::ofstream(file) << "[live]\nvelodyne = \"udp://:0\"\n";
    return file;
  }

 private:
  testing::TemporaryFolder folder_;
};

TEST_P(EachBusCommand, TakesTheOptionElseTheEnvironment) {
  if (takes_drive()) MAPLOOP_REQUIRE_DRIVE();
  const std::string by_environment = said("by-environment://", {});
  if (by_environment.find("built without npm") != std::string::npos) GTEST_SKIP();
  EXPECT_NE(by_environment.find("by-environment://"), std::string::npos) << by_environment;
  const std::string by_option = said("by-environment://", {"--lcm-url", "by-option://"});
  EXPECT_NE(by_option.find("by-option://"), std::string::npos) << by_option;
  EXPECT_EQ(by_option.find("by-environment://"), std::string::npos) << by_option;
}

using Words = std::vector<std::string>;

INSTANTIATE_TEST_SUITE_P(All, EachBusCommand,
                         ::testing::Values(Words{"spy", "--once", "--seconds", "0.1"},
                                           Words{"dashboard", "--port", "0", "--seconds", "0.1"},
                                           Words{"profile", "--live", "--seconds", "0.1"},
                                           Words{"doctor"}, Words{"live", "--seconds", "0.1"},
                                           Words{"replay", "--end", "0.5"}),
                         [](const auto& command) { return command.param[0]; });

TEST(BusCommand, TheConfigurationIsTakenBeforeTheEnvironment) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "a.toml").string();
  std::ofstream(file) << "lcm_url = \"by-configuration://\"\n";
  Words command{"env", "LCM_DEFAULT_URL=by-environment://", maploop_command(), "doctor", "--config",
                file};
  EXPECT_NE(testing::run(command).out.find("by-configuration://"), std::string::npos);
  command.insert(command.end(), {"--lcm-url", "by-option://"});
  const std::string out = testing::run(command).out;
  EXPECT_NE(out.find("by-option://"), std::string::npos) << out;
  EXPECT_EQ(out.find("by-configuration://"), std::string::npos) << out;
}

}  // namespace
}  // namespace maploop
