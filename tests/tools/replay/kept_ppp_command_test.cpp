// Tests that a replay goes on with the filter of PPP that an earlier one has kept (--state).
#include "tests/support/command_test.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

using namespace testing;

class ReplayOfAReceiver : public CommandTest {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_REAL_DATA(); }

  // Returns the hash of PPP_STATE of the fourth minute of a car, and the error output in error_.
  std::string fourth_minute() {
    const ProcessResult run =
        run_maploop({"replay", car_, "--no-lcm", "--lockstep", "--gnss-outage", "0:190", "--end",
                     "240", "--state", file("car.state"), "--json", file("result.json")});
    EXPECT_EQ(run.status, 0) << run.error;
    error_ = run.error;
    return hashes(read_json(file("result.json"))).at("PPP_STATE");
  }

  const std::string car_ = (real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz").string();
  std::string error_;
};

TEST_F(ReplayOfAReceiver, KeepsTheFilterAndGoesOnWithIt) {
  replay(car_, {"--lockstep", "--end", "180", "--state", file("car.state")});
  const std::string kept = read_file(file("car.state.ppp"));
  const std::string warm = fourth_minute();
  EXPECT_NE(read_file(file("car.state.ppp")), kept) << "it has the newer one now";

  write("car.state.ppp", kept.substr(0, kept.size() / 2));
  const std::string cold = fourth_minute();
  EXPECT_NE(warm, cold);
  EXPECT_THAT(error_, AllOf(HasSubstr("car.state.ppp': "), HasSubstr("car.state.ppp.damaged'"),
                            HasSubstr("PPP starts without it")));

  const std::string polo = write("polo.toml", "[vehicle]\nname = \"polo\"\n");
  std::filesystem::copy(file("car.state.ppp"), file("golf.state.ppp"));
  EXPECT_THAT(refusal(car_, {"--state", file("golf.state"), "--config", polo}),
              HasSubstr("it is of the car '', and this is 'polo'"));

  std::filesystem::remove(file("car.state.ppp"));
  EXPECT_EQ(fourth_minute(), cold);
}

TEST_F(ReplayOfAReceiver, KeepsTheFilterOfItsEndAndSaysThatOneIsOfAnotherTime) {
  replay(car_, {"--lockstep", "--end", "3", "--state", file("car.state")});
  const ProcessResult again = run_maploop(
      {"replay", car_, "--no-lcm", "--lockstep", "--end", "3", "--state", file("car.state")});
  EXPECT_EQ(again.status, 0);
  EXPECT_THAT(again.error, HasSubstr("car.state.ppp' is of another time"));
}

}  // namespace
}  // namespace maploop
