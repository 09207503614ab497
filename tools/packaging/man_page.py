#!/usr/bin/env python3
"""Writes a man page from --help of a command and of all its subcommands.

    man_page.py [EMULATOR OPTIONS...] MAPLOOP OUTPUT

A program of another processor is started by the emulator.
"""
import os
import re
import subprocess
import sys


def help_of(*command):
    return subprocess.run([*command, "--help"], capture_output=True, text=True, check=True).stdout


def subcommands(text):
    """Names below "Subcommands:"."""
    listed = re.search(r"^Subcommands:\n((?:  .*\n?)*)", text, re.MULTILINE)
    return re.findall(r"^  ([a-z][a-z-]*)", listed.group(1), re.MULTILINE) if listed else []


def escaped(line):
    line = line.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + line if line.startswith((".", "'")) else line


def pages(started, words=()):
    """(words of the command, help) of it and of what is below it."""
    text = help_of(*started, *words)
    yield words, text
    for name in subcommands(text):
        yield from pages(started, (*words, name))


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    *started, output = sys.argv[1:]
    program = started[-1]
    name = os.path.basename(program)
    version = subprocess.run([*started, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    lines = [f'.TH {name.upper()} 1 "" "maploop {version}"',
             ".SH NAME", f"{name} \\- vehicle localization in real time",
             ".SH SYNOPSIS", f".B {name}", "SUBCOMMAND [OPTIONS]"]
    for words, text in pages(started):
        lines += [f'.SH "{" ".join([name, *words]).upper()}"', ".nf",
                  *(escaped(line) for line in text.strip().replace(program, name).splitlines()), ".fi"]
    with open(output, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
