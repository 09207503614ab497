// Tests which LCM bus the commands use.
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using namespace testing;

// Returns everything that the command prints with this URL in the environment.
std::string said(const std::string& environment, Words words) {
  words.insert(words.begin(), {"env", "LCM_DEFAULT_URL=" + environment, maploop_command()});
  const ProcessResult result = run(words);
  return result.out + result.error;
}

// Each command that uses the bus is ended by a bus that LCM cannot open: its error names the URL
// that it was about to use.
class EachBusCommand : public CommandTest, public ::testing::WithParamInterface<Words> {
 protected:
  Words command() const {
    Words words = GetParam();
    if (words[0] == "replay") words.push_back(drive_0013().string());
    if (words[0] == "live") words.push_back(write("a.toml", "[live]\nvelodyne = \"udp://:0\"\n"));
    return words;
  }
};

TEST_P(EachBusCommand, TakesTheOptionElseTheEnvironment) {
  if (GetParam()[0] == "replay") MAPLOOP_REQUIRE_DRIVE();
  Words words = command();
  const std::string by_environment = said("by-environment://", words);
  if (by_environment.find("built without npm") != std::string::npos) GTEST_SKIP();
  EXPECT_THAT(by_environment, HasSubstr("by-environment://"));
  words.insert(words.end(), {"--lcm-url", "by-option://"});
  EXPECT_THAT(said("by-environment://", words),
              AllOf(HasSubstr("by-option://"), Not(HasSubstr("by-environment://"))));
}

INSTANTIATE_TEST_SUITE_P(All, EachBusCommand,
                         ::testing::Values(Words{"spy", "--once", "--seconds", "0.1"},
                                           Words{"dashboard", "--port", "0", "--seconds", "0.1"},
                                           Words{"profile", "--live", "--seconds", "0.1"},
                                           Words{"doctor"}, Words{"live", "--seconds", "0.1"},
                                           Words{"replay", "--end", "0.5"}),
                         [](const auto& command) { return command.param[0]; });

using BusCommand = CommandTest;

TEST_F(BusCommand, TheConfigurationIsTakenBeforeTheEnvironment) {
  const std::string config = write("a.toml", "lcm_url = \"by-configuration://\"\n");
  Words words{"doctor", "--config", config};
  EXPECT_THAT(said("by-environment://", words), HasSubstr("by-configuration://"));
  words.insert(words.end(), {"--lcm-url", "by-option://"});
  EXPECT_THAT(said("by-environment://", words),
              AllOf(HasSubstr("by-option://"), Not(HasSubstr("by-configuration://"))));
}

}  // namespace
}  // namespace maploop
