#!/usr/bin/env python3
"""The completions for bash, zsh and fish offer what --help lists.

    completion_test.py MAPLOOP FOLDER

MAPLOOP is the command, and FOLDER has the three files. Exit status 77: a shell is not installed.
"""
import os
import shutil
import subprocess
import sys

# Words of a command line, of which the last one is to be completed, what must be offered, and what must not.
CASES = [
    (["ca"], {"calibrate"}, {"--help"}),
    (["replay", "--lo"], {"--lockstep", "--loop"}, {"replay"}),
    (["map", ""], {"build", "doubts", "info"}, {"replay", "--help"}),
    (["map", "build", "--b"], {"--box"}, {"build"}),
    (["replay", "a_driv"], {"a_drive.lcmlog"}, {"calibrate", "--lockstep"}),  # a file of the working folder
]
BASH = """source "$0/completion.bash"
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_maploop
printf '%s\\n' "${COMPREPLY[@]}"
"""
# The functions of zsh's own completion, which works in a terminal alone, print what they are given.
ZSH = """_describe() { print -l -- "${(@)${(@P)2}%%:*}" }
_files() { print -l -- ${words[CURRENT]}*(N) }
compadd() { shift; print -l -- "$@" }
words=("$@"); CURRENT=$#words
source "$0/completion.zsh"
"""
FISH = """source $argv[1]/completion.fish
complete -C (string join -- ' ' $argv[2..])
"""


def offered(shell, folder, words):
    command = {"bash": ["bash", "-c", BASH, folder, *words], "zsh": ["zsh", "-fc", ZSH, folder, *words],
               "fish": ["fish", "-c", FISH, folder, *words]}[shell]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    if done.stderr:
        sys.exit(f"FAILED: {shell} says {done.stderr}")
    return {line.split("\t")[0] for line in done.stdout.splitlines()}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = map(os.path.abspath, sys.argv[1:])
    missing = [shell for shell in ("bash", "zsh", "fish") if shutil.which(shell) is None]
    if missing:
        print(f"SKIPPED, NOT TESTED: not installed: {', '.join(missing)}; run tools/install-packages test")
        sys.exit(77)
    work = os.path.join(os.getcwd(), "completion_test")
    os.makedirs(work, exist_ok=True)
    os.chdir(work)
    open("a_drive.lcmlog", "w").close()
    os.environ["PATH"] = os.path.dirname(program) + ":" + os.environ["PATH"]
    os.environ["HOME"] = work  # fish writes there
    for shell in ("bash", "zsh", "fish"):
        for words, wanted, unwanted in CASES:
            found = offered(shell, folder, ["maploop", *words])
            # A shell may filter what it is given itself.
            if not wanted <= found or (shell != "zsh" and unwanted & found):
                sys.exit(f"FAILED: {shell} completes {' '.join(words)!r} by {sorted(found)} and not by {sorted(wanted)}")
    print(f"{len(CASES)} command lines in 3 shells")


if __name__ == "__main__":
    main()
