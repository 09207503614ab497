#!/usr/bin/env python3
"""Fails on a shared library of a program that is not in its list, and on more than 40.

    libraries_test.py PROGRAM LIST
"""
import re
import subprocess
import sys

MOST = 40


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def name_of(library):
    """Returns libfmt of /usr/lib/libfmt.so.9."""
    return library.rsplit("/", 1)[-1].split(".so")[0]


def loaded(program):
    """Returns the file of each library that the program loads, by its name; of the kernel's no file."""
    libraries = {}
    for line in output_of("ldd", program).splitlines():
        words = line.split()
        libraries[name_of(words[0])] = words[2] if words[1] == "=>" else words[0]
    return libraries


def brought_by(name, files):
    """Returns which of the files need a library themselves."""
    needed = r"\(NEEDED\).*\[" + re.escape(name) + r"\.so"
    return [file for file in files if "/" in file and re.search(needed, output_of("readelf", "-d", file))]


def main():
    program, path = sys.argv[1:]
    with open(path, encoding="utf-8") as file:
        listed = {line.split()[0] for line in file if re.match(r"\w", line)}
    libraries = loaded(program)
    added = sorted(libraries.keys() - listed)
    for name in added:
        who = ", ".join(brought_by(name, [program, *libraries.values()]))
        print(f"{name} is not in {path}; it is needed by {who}")
    if len(libraries) > MOST:
        print(f"{program} loads {len(libraries)} libraries; {MOST} are the most")
    return 1 if added or len(libraries) > MOST else 0


sys.exit(main())
