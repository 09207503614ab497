#!/usr/bin/env python3
"""What tools/test --changed and --resume choose, on a small project that is built here.

    check_test.py FOLDER_OF_THE_CHECK
"""
import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.abspath(sys.argv.pop(1)))
sys.dont_write_bytecode = True
import builds  # noqa: E402
import change  # noqa: E402
from changed import AffectedTests  # noqa: E402
from steps import History, Steps  # noqa: E402
from suite import Suite  # noqa: E402

FILES = {
    "CMakePresets.json": '{"version": 6, "configurePresets": [{"name": "release", "generator": "Ninja",'
                         ' "binaryDir": "${sourceDir}/build/release"}]}',
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(small CXX)\nenable_testing()\n"
                      "set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)\n"
                      "include_directories(${PROJECT_SOURCE_DIR})\n"
                      "add_subdirectory(near)\nadd_subdirectory(far)\nadd_subdirectory(tests/near)\n"
                      "add_subdirectory(tests/far)\n",
    "near/CMakeLists.txt": "add_library(near STATIC near.cpp)\n",
    "near/near.h": "int near_value();\n",
    "near/near.cpp": '#include "near/near.h"\nint near_value() { return 1; }\n',
    "near/rules.txt": "a rule\n",
    "near/PAGE.md": "a page\n",
    "far/CMakeLists.txt": "add_library(far STATIC far.cpp)\ntarget_link_libraries(far near)\n",
    "far/far.h": "int far_value();\n",
    "far/far.cpp": '#include "far/far.h"\n#include "near/near.h"\nint far_value() { return near_value() + 1; }\n',
    "tests/near/CMakeLists.txt": "add_executable(near_test near_test.cpp)\ntarget_link_libraries(near_test near)\n"
                                 "add_test(NAME Near.Value COMMAND near_test)\n",
    "tests/near/near_test.cpp": '#include "near/near.h"\nint main() { return near_value() - 1; }  // see PAGE.md\n',
    "tests/far/CMakeLists.txt": "add_executable(far_test far_test.cpp)\ntarget_link_libraries(far_test far)\n"
                                "add_test(NAME Far.Value COMMAND far_test)\n",
    "tests/far/far_test.cpp": '#include "far/far.h"\nint main() { return far_value() - 2; }\n',
}


def run(command, folder):
    subprocess.run(command, cwd=folder, check=True, capture_output=True, stdin=subprocess.DEVNULL)


class OfAChange(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = os.path.realpath(cls.folder.name)
        for name, text in FILES.items():
            os.makedirs(os.path.join(cls.top, os.path.dirname(name)), exist_ok=True)
            cls.write(name, text)
        cls.write(".gitignore", "/build/\n")
        run(["git", "init", "-q"], cls.top)
        run(["git", "add", "--all"], cls.top)
        run(["git", "-c", "user.name=a", "-c", "user.email=a@localhost", "commit", "-qm", "begin"], cls.top)
        cls.log = os.path.join(cls.top, "build", "log")
        os.makedirs(cls.log)
        run(["cmake", "--preset", "release"], cls.top)
        run(["cmake", "--build", "build/release"], cls.top)
        cls.before = change.tree(cls.top)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def write(cls, name, text):
        with open(os.path.join(cls.top, name), "w", encoding="utf-8") as file:
            file.write(text)

    def affected(self, name, text, seconds=None):
        """The tests that are chosen and left out when one file has another content."""
        self.write(name, text)
        try:
            files = change.changed_files(self.top, self.before, change.tree(self.top))
            self.assertEqual(files, [name])
            with contextlib.redirect_stderr(io.StringIO()):
                found = AffectedTests(self.top, Steps([], {}, self.log), files, seconds or {})
            return found.chosen, {test for tests in found.left_out.values() for test in tests}
        finally:
            self.write(name, FILES[name])

    def test_nothing_changed_is_the_same_tree(self):
        self.assertEqual(change.tree(self.top), self.before)

    def test_a_source_affects_what_links_it(self):
        self.assertEqual(self.affected("far/far.cpp", FILES["far/far.cpp"] + "\n"), ({"Far.Value"}, set()))
        self.assertEqual(self.affected("near/near.cpp", FILES["near/near.cpp"] + "\n"),
                         ({"Near.Value", "Far.Value"}, set()))

    def test_a_header_affects_what_includes_it(self):
        self.assertEqual(self.affected("far/far.h", FILES["far/far.h"] + "\n"), ({"Far.Value"}, set()))

    def test_data_affects_the_code_of_their_folder(self):
        self.assertEqual(self.affected("near/rules.txt", "another rule\n"), ({"Near.Value", "Far.Value"}, set()))

    def test_a_page_affects_the_tests_that_name_it(self):
        self.assertEqual(self.affected("near/PAGE.md", "another page\n"), ({"Near.Value"}, set()))

    def test_the_near_goes_first_and_the_rest_is_named(self):
        self.assertEqual(self.affected("near/near.cpp", "\n" + FILES["near/near.cpp"],
                                       {"Near.Value": 40.0, "Far.Value": 40.0}), ({"Near.Value"}, {"Far.Value"}))

    def test_a_header_is_looked_at_in_the_source_of_its_name_or_in_one_that_includes_it(self):
        self.assertEqual(builds.sources_to_look_at(self.top, ["near/near.h", "near/PAGE.md"]), ["near/near.cpp"])
        self.assertEqual(builds.sources_to_look_at(self.top, ["far/far.cpp", "far/far.h"]), ["far/far.cpp"])
        os.rename(os.path.join(self.top, "far/far.cpp"), os.path.join(self.top, "far/other.cpp"))
        try:
            self.assertEqual(builds.sources_to_look_at(self.top, ["far/far.h"]), ["far/other.cpp"])
        finally:
            os.rename(os.path.join(self.top, "far/other.cpp"), os.path.join(self.top, "far/far.cpp"))

    def test_what_differs_is_counted_from_the_last_commit_that_passed(self):
        self.assertIsNone(change.base(self.top, None), "the first commit has none before it")
        self.assertIsNone(change.base(self.top, "0" * 40))
        head = change.output(["git", "rev-parse", "HEAD"], self.top).strip()
        self.assertEqual(change.base(self.top, head), self.before)

    def test_tests_can_be_chosen_and_say_when_they_pass(self):
        suite = Suite(os.path.join(self.top, "build", "check"), [os.path.join(self.top, "build", "release")], self.log)
        self.assertEqual({test["name"] for test in suite.tests()}, {"Near.Value", "Far.Value"})
        passed = []
        status, results = suite.run(2, {"Far.Value": 1.0}, {"Far.Value"}, passed.append)
        self.assertEqual((status, passed), (0, ["Far.Value"]))
        self.assertEqual([(r["test"], r["verdict"]) for r in results], [("Far.Value", "passed")])
        self.assertIn("100% tests passed", suite.summary())


class OfTimes(unittest.TestCase):
    def test_history_is_kept_and_a_broken_one_is_forgotten(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "of", "check.json")
            history = History(path)
            history.update("tests", {"A.B": 2.5})
            history.save()
            self.assertEqual(History(path).of("tests"), {"A.B": 2.5})
            with open(path, "w", encoding="utf-8") as file:
                file.write("{")
            self.assertEqual(History(path).of("tests"), {})

    def test_the_cache_is_counted(self):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write("# a.cpp\ndirect_cache_hit\nlocal_storage_hit\n# b.cpp\ncache_miss\n# c.cpp\npreprocessed_cache_hit\n")
            file.flush()
            self.assertEqual(builds.compiled(file.name), {"compiled": 3, "cached": 2})


if __name__ == "__main__":
    unittest.main()
