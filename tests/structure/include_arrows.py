#!/usr/bin/env python3
"""Fails on an include against the arrows between the folders.

    include_arrows.py ROOT

    msgs <- runtime/core, sensors, estimators/*, mapmatch, ppp <- runtime/vehicle <- tools

A folder may include itself and what ALLOWED names. Includes are written from the repository's root.
A header that another folder includes brings in none of the HEAVY libraries, at no depth: a folder keeps
those in its .cpp files and in the headers that it alone uses.
"""
import os
import re
import sys

LCM = ("lcm", "maploop_lcm")
HEAVY = ("opencv2", "opencv", "pcl", "toml++", "toml.hpp", "nlohmann", *LCM)

EVERYTHING_BELOW_VEHICLE = ["msgs", "msgs/lcm", "runtime/core", "sensors", "estimators", "mapmatch",
                            "ppp"]

# Maps a folder to the folders that it may include besides itself. The longest name that fits a file
# counts, so that estimators/stereo and estimators/fusion are two folders. Each new folder is added here.
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
# The first may include LCM; the headers of the second may bring in anything.
USES_LCM = ("msgs/lcm", "sensors", "runtime/vehicle", "tools", "tests")
FREE_HEADERS = ("msgs/lcm", "tests")

SOURCE = re.compile(r"\.(h|hpp|hh|inl|c|cc|cpp|cxx)$")
NOT_OURS = re.compile(r"^(build|\..*)$")  # folders at the root
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
INCLUDE = re.compile(r"^[ \t]*#[ \t]*include[ \t]*(?:([<\"])([^>\"\n]*)[>\"]|(.*))", re.MULTILINE)


def below(path, folder):
    return path == folder or path.startswith(folder + "/")


def folder_of(path):
    """Returns the folder of ALLOWED that a path belongs to, or None."""
    return max((folder for folder in ALLOWED if below(path, folder)), key=len, default=None)


def permits(allowed, target):
    """Returns whether a list of folders covers a target; "msgs" does not cover "msgs/lcm"."""
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
    """Blanks comments and keeps the lines in their places. (No include is after a // in a string.)"""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def includes(root, source):
    """Yields (line, name, whether it is meant to be a file of ours, text of a computed include)."""
    with open(os.path.join(root, source), encoding="utf-8", errors="replace") as file:
        text = without_comments(file.read())
    for match in INCLUDE.finditer(text):
        quote, name, computed = match.groups()
        # An include in quotes is meant to be ours, unless it is a known library.
        ours = name is not None and (folder_of(name) or (quote == '"' and not is_heavy(name)))
        yield text.count("\n", 0, match.start()) + 1, name, bool(ours), computed


def is_heavy(name):
    return name.split("/")[0] in HEAVY


def chain_to_heavy(root, header, seen):
    """Returns the includes that lead from a header to a heavy library, the library last; or None."""
    if header in seen or folder_of(header) in FREE_HEADERS:
        return None
    seen.add(header)
    for _, name, ours, _ in includes(root, header):
        if name is None:
            continue
        if not ours:
            if is_heavy(name):
                return [header, name]
        elif os.path.exists(os.path.join(root, name)):
            chain = chain_to_heavy(root, name, seen)
            if chain:
                return [header, *chain]
    return None


def wrong_include(root, source, name, ours):
    """Returns why a source must not include `name`, or None."""
    folder = folder_of(source)
    if not ours:
        if name.split("/")[0] in LCM and folder not in USES_LCM:
            return f"{folder} does not know LCM"
        return None
    target = folder_of(name)
    if not os.path.exists(os.path.join(root, name)):
        return "there is no such file from the repository's root, where includes are written from"
    if target is None:
        return "this folder is not in the table of tests/structure/include_arrows.py"
    if target == folder:
        return None
    if not permits(ALLOWED[folder], target):
        return f"{folder} must not include {target}"
    chain = None if folder == "tests" else chain_to_heavy(root, name, set())
    if chain:
        return f"it brings in {chain[-1]} ({' -> '.join(chain)}); hide that in a .cpp of {target}"
    return None


def violations(root):
    """Returns every include against the arrows, as 'file:line: include: why'."""
    found = []
    for source in sources(root):
        if folder_of(source) is None:
            found.append(f"{source}:1: its folder is not in the table of tests/structure/include_arrows.py")
            continue
        for line, name, ours, computed in includes(root, source):
            why = "write the file's name" if name is None else wrong_include(root, source, name, ours)
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
        sys.exit(f"{len(found)} includes against the arrows (README, 'How it is made')")
    print(f"{count} files follow the arrows")


if __name__ == "__main__":
    main()
