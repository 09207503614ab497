"""Builds one of the presets, and counts what the compiler cache had."""
import concurrent.futures
import json
import os
import re
import subprocess
import time
from collections import Counter


def build(steps, top, preset, targets=()):
    """Configures and builds; returns what is worth keeping of it."""
    log = os.path.join(steps.log, f"ccache-{preset}.txt")
    if os.path.exists(log):
        os.remove(log)
    environment = {**os.environ, "CCACHE_STATSLOG": log}
    steps.logged(f"configure-{preset}", ["cmake", "--preset", preset], cwd=top, env=environment)
    command = ["cmake", "--build", "--preset", preset, "-j", str(os.cpu_count())]
    if targets:
        command += ["--target", *targets]
    steps.logged(f"build-{preset}", command, cwd=top, env=environment)
    return compiled(log)


def compiled(log):
    """How many files were compiled, and how many of them the cache had."""
    try:
        with open(log, encoding="utf-8") as file:
            counts = Counter(line.strip() for line in file if not line.startswith("#"))
    except OSError:
        counts = Counter()
    had = counts["direct_cache_hit"] + counts["preprocessed_cache_hit"]
    return {"compiled": had + counts["cache_miss"], "cached": had}


def why_not_sanitized(log, flag, launcher):
    """Why no program built so starts on this machine, or None."""
    program = os.path.join(log, "sanitizer_probe")
    built = subprocess.run(["g++", "-x", "c++", f"-fsanitize={flag}", "-o", program, "-"], input="int main() {}",
                           capture_output=True, text=True, check=False)
    started = built if built.returncode else subprocess.run([launcher, program], capture_output=True, text=True,
                                                            check=False)
    if started.returncode == 0:
        return None
    return (started.stderr.strip().splitlines() or ["no reason given"])[-1]


def not_formatted(top, files=None):
    """The files that clang-format would change, of `files` or of all."""
    if files is None:
        find = ["find", ".", "-path", "./build", "-prune", "-o", "-type", "f", "-print"]
        files = subprocess.run(find, cwd=top, capture_output=True, text=True, check=True).stdout.splitlines()
    sources = "".join(f"{f}\0" for f in files
                      if f.endswith((".h", ".cpp")) and os.path.isfile(os.path.join(top, f)))
    listed = subprocess.run(["xargs", "-0", "-r", "clang-format", "--dry-run"], input=sources, cwd=top,
                            capture_output=True, text=True, check=False).stderr
    return sorted(set(re.findall(r"^(\S+?):\d+:\d+: warning:", listed, re.MULTILINE)))


def sources_to_look_at(top, files):
    """The sources that show a linter `files`: sources themselves, and one source for each header, which is the one
    of its name or else the first that includes it."""
    chosen = []
    for name in files:
        found = [name] if name.endswith(".cpp") else []
        if name.endswith(".h"):
            own = name[:-2] + ".cpp"
            including = subprocess.run(["git", "grep", "-l", "--untracked", "-F", f'#include "{name}"', "--", "*.cpp"],
                                       cwd=top, capture_output=True, text=True, check=False).stdout.splitlines()
            found = [own] if os.path.isfile(os.path.join(top, own)) else including[:1]
        chosen += [f for f in found if os.path.isfile(os.path.join(top, f)) and f not in chosen]
    return chosen


def bug_patterns(steps, top, sources, headers=None, seconds=None):
    """Compiles `sources` with clang and looks for bug patterns and names (.clang-tidy) in them and in `headers`
    (default: all of ours); begins none after `seconds`, and none that this machine's build leaves out.

    Returns (the text of what was found, the sources that were not looked at).
    """
    names = [] if headers is None else ["--header-filter=/(" + "|".join(map(re.escape, headers)) + ")$"]
    steps.logged("configure-tidy", ["cmake", "--preset", "tidy"], cwd=top)
    with open(os.path.join(top, "build", "tidy", "compile_commands.json"), encoding="utf-8") as file:
        built = {os.path.relpath(entry["file"], top) for entry in json.load(file)}
    end = time.monotonic() + (seconds or float("inf"))

    def look(source):
        if source not in built or time.monotonic() > end:
            return None
        done = subprocess.run(["clang-tidy", "-quiet", "-p", "build/tidy", *names, source], cwd=top, capture_output=True,
                              text=True, check=False, stdin=subprocess.DEVNULL)
        return done.stdout + done.stderr if done.returncode else ""

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = dict(zip(sources, pool.map(look, sources)))
    text = "".join(said for said in found.values() if said)
    with open(os.path.join(steps.log, "clang-tidy.txt"), "w", encoding="utf-8") as file:
        file.write(text)
    return text, [source for source, said in found.items() if said is None]
