"""Builds the package by CMake in build/release, and packs it for pip (README.md)."""
import glob
import os
import shutil
import subprocess

from setuptools import Distribution, setup
from setuptools.command.build_ext import build_ext

os.chdir(os.path.dirname(os.path.abspath(__file__)))
ROOT = os.path.join("..", "..")


class BuildByCMake(build_ext):
    def run(self):
        built = os.path.join(ROOT, "build", "release", "python", "maploop")
        subprocess.run(["cmake", "--preset", "release"], cwd=ROOT, check=True)
        subprocess.run(["cmake", "--build", "--preset", "release", "--target", "maploop_python"], cwd=ROOT, check=True)
        modules = glob.glob(os.path.join(built, "_maploop.*.so"))
        if len(modules) != 1:
            raise RuntimeError(f"{built} has {len(modules)} modules in place of one; remove those of other interpreters")
        shutil.copytree(built, os.path.join(self.build_lib, "maploop"), dirs_exist_ok=True)


class HasModule(Distribution):
    def has_ext_modules(self):
        return True


def version():
    with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as file:
        return file.read().split("project(maploop VERSION ")[1].split()[0]


setup(
    name="maploop",
    version=version(),
    description="Vehicle localization in real time that closes the loop through the road map",
    license="MIT",
    py_modules=[],
    python_requires=">=3.11",
    install_requires=["numpy"],
    distclass=HasModule,
    cmdclass={"build_ext": BuildByCMake},
    # maploop looks for share/maploop above its module.
    data_files=[
        ("share/maploop/rules", sorted(glob.glob(os.path.join(ROOT, "mapmatch", "rules", "*")))),
        ("share/maploop", [os.path.join(ROOT, "sensors", "replay", "kitti_sequences.csv")]),
    ],
)
