// Tests `maploop vehicle` as users run it.
#include "tests/support/command_test.h"

namespace maploop {
namespace {

using namespace testing;
using ::testing::AllOf;

using VehicleCommand = CommandTest;
using KittisVehicle = DriveTest;

TEST_F(VehicleCommand, NewAsksAndDoesNotOverwrite) {
  const Words ask{
      "/bin/sh", "-c",
      "printf '\\n\\n1.4 0.05\\n\\n\\n\\n\\n\\nn\\nn\\nn\\nn\\n' | \"$0\" vehicle new \"$1\"",
      maploop_command(), file("car.toml")};
  EXPECT_EQ(run(ask).status, 0);
  EXPECT_THAT(read_file(file("car.toml")),
              AllOf(HasSubstr("[vehicle]\nrear_axle_distance = 1.4  # m. "),
                    HasSubstr("rear_axle_distance_sigma = 0.05")));
  const ProcessResult again = run(ask);
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.error, HasSubstr("car.toml' exists already"));
}

TEST_F(VehicleCommand, CheckNamesTheLineThatIsWrong) {
  const std::string car = write("car.toml", "[vehicle.camera]\nyaw = 200.0\n");
  const ProcessResult wrong = run_maploop({"vehicle", "check", car});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.error, HasSubstr("car.toml:2:7: vehicle.camera.yaw: is 200; allowed is"));
  write("car.toml", "[vehicle.camera]\nyaw = 180.0\n");
  const ProcessResult odd = run_maploop({"vehicle", "check", car});
  EXPECT_EQ(odd.status, 0) << odd.error;
  EXPECT_THAT(odd.out, AllOf(HasSubstr("warning: [vehicle.camera] looks backwards"),
                             HasSubstr("not given, and therefore assumed:"),
                             HasSubstr("car.toml can be used")));
}

TEST_F(KittisVehicle, ConvertedReplaysWithTheBitsOfThePreset) {
  const std::string car = file("kitti.toml");
  const ProcessResult made = run_maploop({"vehicle", "convert", "kitti", drive(), car});
  ASSERT_EQ(made.status, 0) << made.error;
  EXPECT_THAT(run_maploop({"vehicle", "convert", "kitti", drive(), car}).error,
              HasSubstr("kitti.toml' exists already"));
  EXPECT_EQ(run_maploop({"vehicle", "check", car}).status, 0);
  EXPECT_EQ(run_maploop({"vehicle", "draw", car, file("kitti.svg")}).status, 0);
  EXPECT_THAT(read_file(file("kitti.svg")), HasSubstr("</svg>"));

  const auto replayed = [&](Words more) {
    more.insert(more.end(), {"--lockstep", "--end", "3"});
    return hashes(replay(drive(), more));
  };
  const auto preset = replayed({});
  EXPECT_EQ(replayed({"--config", car}), preset);
  const std::string other =
      write("other.toml", "[vehicle]\nfile = \"kitti.toml\"\n[vehicle.camera]\nforward = 2.0\n");
  EXPECT_NE(replayed({"--config", other}), preset) << "another place of the camera has an effect";
}

}  // namespace
}  // namespace maploop
