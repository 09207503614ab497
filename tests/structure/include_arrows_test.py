#!/usr/bin/env python3
"""Tests the checker itself on synthetic trees."""
import os
import subprocess
import sys
import tempfile
import unittest

CHECKER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "include_arrows.py")

# A good tree contains these files, so that includes find them.
GOOD = {
    "msgs/time.h": "#include <cstdint>\n#include <Eigen/Core>\n",
    "msgs/lcm/conversions.h": '#include <maploop_lcm/imu_t.hpp>\n#include "msgs/time.h"\n',
    "runtime/core/ring.h": '#include "msgs/time.h"\n',
    "runtime/vehicle/graph/vehicle.h": '#include "runtime/core/ring.h"\n',
    "runtime/vehicle/output/publisher.cpp": '#include <lcm/lcm-cpp.hpp>\n#include "msgs/lcm/conversions.h"\n'
                                     '#include "estimators/stereo/tracker.h"\n'
                                     '#include "sensors/camera/driver.h"\n',
    "sensors/camera/driver.h": '#include "msgs/time.h"\n',
    "sensors/camera/driver.cpp": '#include <opencv2/imgcodecs.hpp>\n#include "sensors/camera/driver.h"\n',
    "estimators/stereo/tracker.h": '#include "msgs/time.h"\n',
    "estimators/stereo/tracker.cpp": '#include "estimators/stereo/tracker.h"\n#include <opencv2/core.hpp>\n',
    "estimators/fusion/filter.h": '#include "msgs/time.h"\n',
    "mapmatch/matcher.h": '#include "msgs/time.h"\n',
    "ppp/filter.h": '#include "msgs/time.h"\n',
    "tools/command/main.cpp": '#include "runtime/vehicle/graph/vehicle.h"\n#include <toml++/toml.h>\n',
    "tests/msgs/time_test.cpp": '#include "msgs/time.h"\n#include "tools/score.h"\n',
    "tools/score.h": '#include "msgs/time.h"\n',
    "build/release/generated.h": '#include "nowhere.h"\n',  # this is not checked
}


def check(tree):
    """Returns the checker's exit status and output on a tree of {name: text}."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in tree.items():
            path = os.path.join(root, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run([sys.executable, CHECKER, root], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class IncludeArrows(unittest.TestCase):
    def assert_refused(self, name, text, *words):
        status, output = check({**GOOD, name: text})
        self.assertEqual(status, 1, f"{name} was let through: {text!r}")
        for word in (name, *words):
            self.assertIn(word, output)
        self.assertIn("1 includes against", output, "it alone is to be refused")

    def assert_fine(self, name, text):
        self.assertEqual(check({**GOOD, name: text})[0], 0, check({**GOOD, name: text})[1])

    def test_good_tree(self):
        status, output = check(GOOD)
        self.assertEqual(status, 0, output)
        self.assertIn("15 files", output)

    def test_against_the_arrows(self):
        for name, include, target in (
                ("msgs/bad.h", "runtime/core/ring.h", "runtime/core"),
                ("msgs/bad.h", "msgs/lcm/conversions.h", "msgs/lcm"),
                ("runtime/core/bad.h", "sensors/camera/driver.h", "sensors"),
                ("runtime/core/bad.cpp", "runtime/vehicle/graph/vehicle.h", "runtime/vehicle"),
                ("runtime/core/bad.cpp", "msgs/lcm/conversions.h", "msgs/lcm"),
                ("sensors/imu/bad.cpp", "runtime/core/ring.h", "runtime/core"),
                ("sensors/imu/bad.cpp", "estimators/fusion/filter.h", "estimators/fusion"),
                ("estimators/stereo/bad.cpp", "estimators/fusion/filter.h", "estimators/fusion"),
                ("estimators/stereo/bad.cpp", "runtime/core/ring.h", "runtime/core"),
                ("estimators/stereo/bad.cpp", "sensors/camera/driver.h", "sensors"),
                ("estimators/fusion/bad.cpp", "msgs/lcm/conversions.h", "msgs/lcm"),
                ("estimators/fusion/bad.cpp", "mapmatch/matcher.h", "mapmatch"),
                ("mapmatch/bad.cpp", "ppp/filter.h", "ppp"),
                ("mapmatch/bad.cpp", "estimators/fusion/filter.h", "estimators/fusion"),
                ("ppp/bad.h", "mapmatch/matcher.h", "mapmatch"),
                ("runtime/vehicle/bad.cpp", "tools/score.h", "tools"),
                ("tools/bad.cpp", "tests/support/real_data.h", "tests")):
            with self.subTest(name=name, include=include):
                tree_has = {} if include in GOOD else {include: ""}
                status, output = check({**GOOD, **tree_has, name: f'\n#include "{include}"\n'})
                self.assertEqual(status, 1, output)
                self.assertIn(f"{name}:2: includes {include}", output)
                self.assertIn(f"must not include {target}", output)

    def test_angle_brackets_and_blanks_do_not_hide_an_include(self):
        self.assert_refused("mapmatch/bad.cpp", "#include <ppp/filter.h>\n", "must not include ppp")
        self.assert_refused("mapmatch/bad.cpp", '  #  include"ppp/filter.h"\n', "must not include ppp")

    def test_computed_include(self):
        self.assert_refused("mapmatch/bad.cpp", "#include HEADER\n", "write the file's name")

    def test_commented_out_include_does_not_count(self):
        self.assert_fine("mapmatch/fine.cpp", '// #include "ppp/filter.h"\n/*\n#include "ppp/filter.h"\n*/\n')

    def test_include_not_from_the_root(self):
        self.assert_refused("msgs/bad.h", '#include "time.h"\n', "from the repository's root")
        self.assert_refused("msgs/bad.h", '#include "../msgs/time.h"\n')

    def test_estimators_do_not_know_lcm(self):
        self.assert_refused("estimators/fusion/bad.cpp", "#include <lcm/lcm-cpp.hpp>\n", "LCM")
        self.assert_refused("ppp/bad.cpp", "#include <maploop_lcm/imu_t.hpp>\n", "LCM")
        self.assert_refused("msgs/bad.cpp", "#include <lcm/lcm.h>\n", "LCM")

    def test_heavy_libraries_do_not_leave_their_folder(self):
        for library in ("opencv2/core.hpp", "pcl/point_types.h", "toml++/toml.h", "nlohmann/json.hpp"):
            for include in (f"#include <{library}>\n", f'#include "{library}"\n'):
                with self.subTest(include=include):
                    status, output = check({**GOOD, "runtime/core/ring.h": include})
                    self.assertEqual(status, 1, output)
                    self.assertIn("runtime/vehicle/graph/vehicle.h:1: includes runtime/core/ring.h: it brings "
                                  f"in {library}", output)

    def test_heavy_library_at_depth(self):
        status, output = check({**GOOD, "runtime/core/ring.h": '#include "runtime/core/detail.h"\n',
                                "runtime/core/detail.h": '#include "runtime/core/ring.h"\n'  # a circle
                                                         "#include <toml++/toml.h>\n"})
        self.assertEqual(status, 1, output)
        self.assertIn("runtime/core/ring.h -> runtime/core/detail.h -> toml++/toml.h", output)

    def test_heavy_library_in_a_header_that_its_folder_alone_uses(self):
        self.assert_fine("estimators/stereo/pyramid.h", "#include <opencv2/core.hpp>\n")
        self.assert_fine("tools/page.h", "#include <nlohmann/json.hpp>\n")

    def test_tests_may_look_inside(self):
        status, output = check({**GOOD, "estimators/stereo/pyramid.h": "#include <opencv2/core.hpp>\n",
                                "tests/a_test.cpp": '#include "estimators/stereo/pyramid.h"\n'})
        self.assertEqual(status, 0, output)

    def test_folder_that_nobody_wrote_down(self):
        self.assert_refused("estimators/radar/odometry.h", "", "not in the table")
        self.assert_refused("helpers/strings.cpp", "", "not in the table")

    def test_empty_tree_is_no_success(self):
        self.assertEqual(check({"README.md": ""})[0], 1)


if __name__ == "__main__":
    unittest.main()
