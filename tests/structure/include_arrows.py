#!/usr/bin/env python3
"""Fails on an include against the arrows between the folders.

    include_arrows.py ROOT

    msgs <- runtime/core, sensors, estimators/*, mapmatch, ppp <- runtime/vehicle <- tools

A folder may include itself and what ALLOWED names. Includes are written from the repository's root.
Third-party libraries that would tie every user of a header to them stay in .cpp files.
"""
import os
import re
import sys

LCM = ("lcm", "maploop_lcm")
HEAVY = ("opencv2", "opencv", "pcl", "toml++", "toml.hpp", "nlohmann", *LCM)

EVERYTHING_BELOW_VEHICLE = ["msgs", "msgs/lcm", "runtime/core", "sensors", "estimators", "mapmatch", "ppp"]

# Folder -> folders it may include besides itself. The longest name that fits a file counts, so that
# estimators/stereo and estimators/fusion are two folders; each new one is written down here.
ALLOWED = {
    "msgs": [],
    "msgs/lcm": ["msgs"],
    "runtime/core": ["msgs"],
    "runtime/vehicle": EVERYTHING_BELOW_VEHICLE,
    "sensors": ["msgs", "msgs/lcm"],
    "estimators/stereo": ["msgs"],
    "estimators/lidar": ["msgs"],
    "estimators/fusion": ["msgs"],
    "mapmatch": ["msgs"],
    "ppp": ["msgs"],
    "tools": [*EVERYTHING_BELOW_VEHICLE, "runtime/vehicle"],
    "tests": [*EVERYTHING_BELOW_VEHICLE, "runtime/vehicle", "tools"],
}
# Where LCM may be included, and where a header may include anything of others.
USES_LCM = ("msgs/lcm", "sensors", "runtime/vehicle", "tools", "tests")
FREE_HEADERS = ("msgs/lcm", "tests")

SOURCE = re.compile(r"\.(h|hpp|hh|inl|c|cc|cpp|cxx)$")
HEADER = re.compile(r"\.(h|hpp|hh|inl)$")
NOT_OURS = re.compile(r"^(build|\..*)$")  # folders at the root
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*(?:([<\"])([^>\"\n]*)[>\"]|(.*))", re.MULTILINE)


def below(path, folder):
    return path == folder or path.startswith(folder + "/")


def folder_of(path):
    """The folder of ALLOWED that a path belongs to, or None."""
    return max((folder for folder in ALLOWED if below(path, folder)), key=len, default=None)


def permits(allowed, target):
    """Whether a list of folders covers a target: "msgs" does not cover "msgs/lcm"."""
    return any(below(target, folder) for folder in allowed
               if not (folder == "msgs" and below(target, "msgs/lcm")))


def sources(root):
    for where, folders, files in os.walk(root):
        if where == root:
            folders[:] = [name for name in folders if not NOT_OURS.match(name)]
        folders.sort()
        for name in sorted(files):
            if SOURCE.search(name):
                yield os.path.relpath(os.path.join(where, name), root)


def without_comments(text):
    """Comments blanked, lines kept where they are. (A // inside a string ends no include.)"""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def wrong_include(root, source, quote, name):
    """Why a source must not include `name`, or None."""
    folder = folder_of(source)
    library = name.split("/")[0]
    target = folder_of(name)
    if target is None and not (quote == '"' and library not in HEAVY):
        if library in LCM and folder not in USES_LCM:
            return f"{folder} does not know LCM"
        if library in HEAVY and HEADER.search(source) and folder not in FREE_HEADERS:
            return f"a header must not include {library}; include it in the .cpp"
        return None
    if not os.path.exists(os.path.join(root, name)):
        return "there is no such file from the repository's root, where includes are written from"
    if target is None:
        return "this folder is not in the table of tests/structure/include_arrows.py"
    if target != folder and not permits(ALLOWED[folder], target):
        return f"{folder} must not include {target}"
    return None


def violations(root):
    """Every include against the arrows, as 'file:line: include: why'."""
    found = []
    for source in sources(root):
        if folder_of(source) is None:
            found.append(f"{source}:1: its folder is not in the table of tests/structure/include_arrows.py")
            continue
        with open(os.path.join(root, source), encoding="utf-8", errors="replace") as file:
            text = without_comments(file.read())
        for match in INCLUDE.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            quote, name, computed = match.groups()
            if computed is not None:
                why = "write the file's name"
            else:
                why = wrong_include(root, source, quote, name)
            if why:
                found.append(f"{source}:{line}: includes {name or computed.strip()}: {why}")
    return found


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit(__doc__)
    root = os.path.abspath(sys.argv[1])
    found = violations(root)
    for line in found:
        print(line)
    count = sum(1 for _ in sources(root))
    if count == 0:
        sys.exit(f"no source file below {root}: nothing was checked")
    if found:
        sys.exit(f"{len(found)} includes against the arrows (design.md, 'The house')")
    print(f"{count} files follow the arrows")


if __name__ == "__main__":
    main()
