#!/usr/bin/env python3
"""Runs one file of tests by pytest; status 77, with the reason, where nothing of it can be tested.

    run.py TEST_FILE FOLDER_OF_THE_MODULE MAPLOOP
"""
import os
import sys

sys.dont_write_bytecode = True
test_file, folder, os.environ["MAPLOOP"] = sys.argv[1:]
sys.path.insert(0, folder)
os.environ["PYTHONPATH"] = folder
try:
    import numpy  # noqa: F401
    import pytest

    import maploop  # noqa: F401
except ImportError as error:
    print(f"SKIPPED, NOT TESTED: {error}; tools/install-packages build test")
    sys.exit(77)


class Passed:
    count = 0

    def pytest_runtest_logreport(self, report):
        self.count += report.when == "call" and report.passed


passed = Passed()
status = pytest.main(["-q", "-rs", "-p", "no:cacheprovider", "--durations=3", test_file], plugins=[passed])
sys.exit(77 if status == 0 and passed.count == 0 else int(status))
