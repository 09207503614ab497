"""Checks everything, as tools/test says; started by it."""
import argparse
import json
import os
import sys

import builds
import change
from changed import AffectedTests
from steps import History, StepFailed, Steps, minutes, say
from suite import Suite

SANITIZERS = {"asan": "address,undefined", "tsan": "thread"}
# Seconds that steps take on a bare machine of two cores, until one has been seen.
FIRST_TIME = {"the recorded drive": 12, "formatting": 6, "building: release": 1050, "building: asan": 560,
              "building: tsan": 300, "tests": 1080, "bug patterns": 60}
TIDY_SECONDS = 240.0  # no source is begun after this time in a run that is not asked for bug patterns


class Check:
    def __init__(self, top, options):
        self.top, self.options = top, options
        self.cache = os.path.abspath(os.environ.get("MAPLOOP_CACHE") or os.path.expanduser("~/.cache/maploop"))
        os.environ["MAPLOOP_CACHE"] = self.cache
        self.log = os.path.join(top, "build", "log")
        os.makedirs(self.log, exist_ok=True)
        self.history = History(os.path.join(self.cache, "check.json"))
        names = ["the recorded drive", "formatting", "building: release"]
        if not options.quick and not options.changed:
            names += [f"building: {preset}" for preset in SANITIZERS]
        if options.tidy or not (options.quick or options.changed):
            names += ["bug patterns"]
        names += ["tests"]
        self.steps = Steps(names, {**FIRST_TIME, **self.history.of("steps")}, self.log)
        self.steps.add_finished("packages", options.packages_seconds)
        self.tree = change.tree(top)
        self.suite, self.results, self.skipped_suites = None, [], []

    def file(self, name):
        return os.path.join(self.log, name)

    def read(self, name):
        try:
            with open(self.file(name), encoding="utf-8") as file:
                return file.read()
        except OSError:
            return ""

    def run(self):
        """The exit status: 0 when every step passed."""
        self.steps.run("the recorded drive", self.restore_drive)
        changed = self.changed_files() if self.options.changed else None
        self.steps.run("formatting", lambda: self.check_formatting(changed))
        affected = None
        if self.options.changed:
            affected = AffectedTests(self.top, self.steps, changed, self.history.of("tests"))
            self.steps.run("building: release",
                           lambda: self.build("release", affected.programs) if affected.programs else None)
        else:
            self.steps.run("building: release", lambda: self.build("release"))
        presets = ["release"]
        if not self.options.quick and not self.options.changed:
            presets += self.build_sanitized()
        if "bug patterns" in self.steps.waiting:
            self.steps.run("bug patterns", self.find_bug_patterns)
        self.steps.run("tests", lambda: self.run_tests(presets, affected and affected.chosen))
        if affected:
            affected.say_what_was_not_run()
        elif self.status == 0 and not self.options.quick and not self.skipped_suites:
            with open(self.file("green"), "w", encoding="utf-8") as file:
                file.write(f"{self.tree}\n")
            if self.tree and self.tree == change.output(["git", "rev-parse", "HEAD^{tree}"], self.top).strip():
                self.history.update("green", {"commit": change.output(["git", "rev-parse", "HEAD"], self.top).strip()})
        return self.status

    # The steps.

    def restore_drive(self):
        self.steps.logged("restore-drive", ["bash", "-c", '"$0" || { status=$?; [ $status = 77 ] || exit $status; }',
                                            os.path.join(self.top, "tools", "restore-drive")])
        said = self.read("restore-drive.txt")
        say(said.strip().split("\n")[-1])
        if "no real data" in said:
            say("SKIPPED, NOT TESTED: every test of real data")

    def check_formatting(self, changed):
        files = builds.not_formatted(self.top, changed)
        if files:
            raise StepFailed("FAILED: not formatted; do: clang-format -i " + " ".join(files))

    def build(self, preset, targets=()):
        return builds.build(self.steps, self.top, preset, targets)

    def build_sanitized(self):
        """Builds what can be tested here; returns the presets."""
        presets = []
        for preset, flag in SANITIZERS.items():
            launcher = os.path.join(self.top, "tests", "support", "sanitized")
            reason = builds.why_not_sanitized(self.log, flag, launcher)
            if reason:
                self.skipped_suites.append(
                    f"SKIPPED, NOT TESTED: no program built with -fsanitize={flag} starts here: {reason}")
                say(self.skipped_suites[-1])
                self.steps.waiting.remove(f"building: {preset}")
                continue
            self.steps.run(f"building: {preset}", lambda p=preset: self.build(p))
            presets.append(preset)
        return presets

    def run_tests(self, presets, only):
        self.suite = Suite(os.path.join(self.top, "build", "check"),
                           [os.path.join(self.top, "build", preset) for preset in presets], self.log)
        names = {test["name"] for test in self.suite.tests()}
        chosen = names if only is None else names & only
        before = self.passed_before() if self.options.resume else set()
        if before < chosen:
            chosen = chosen - before
        history = self.history.of("tests")
        with open(self.file("passed.txt"), "w", encoding="utf-8") as file:

            def passed(name):
                file.write(name + "\n")
                file.flush()

            for name in [self.tree or "no git", *before]:
                passed(name)
            # One more than there are cores: an eighth of their time was idle while tests waited.
            self.status, self.results = self.suite.run(
                os.cpu_count() + 1, {name: history.get(name, 0.1) for name in chosen},
                None if chosen == names else chosen, passed)
        return {"tests": len(self.results)}

    def passed_before(self):
        """The tests that passed before an interruption, of the tree as it is."""
        tree, *names = self.read("passed.txt").split("\n")
        if not self.tree or tree != self.tree:
            say("nothing to resume: the files have changed since the last run")
            return set()
        say(f"{len(names) - 1} tests passed before the interruption and are not run again")
        return set(names) - {""}

    def changed_files(self):
        green = self.read("green").strip()
        if not self.tree:
            raise StepFailed("FAILED: --changed needs a git checkout; tools/test --quick runs everything of the release")
        if not green:
            say("no run has passed here yet: what is committed is taken for tested")
            green = change.output(["git", "rev-parse", "HEAD^{tree}"], self.top).strip()
        return change.changed_files(self.top, green, self.tree)

    def find_bug_patterns(self):
        """Of the whole tree with --tidy; else of what differs from the last commit that passed on this machine."""
        if self.options.tidy:
            files = change.output(["git", "ls-files", "*.cpp", "*.h"], self.top).splitlines()
        else:
            base = self.tree and change.base(self.top, self.history.of("green").get("commit"))
            files = change.changed_files(self.top, base, self.tree) if base else []
        sources = builds.sources_to_look_at(self.top, files)
        if not sources:
            return {"sources": 0}
        found, left = (builds.bug_patterns(self.steps, self.top, sources) if self.options.tidy else
                       builds.bug_patterns(self.steps, self.top, sources, [f for f in files if f.endswith(".h")],
                                           TIDY_SECONDS))
        if left:
            say(f"NOT LOOKED AT for bug patterns, as time was short or nothing here builds them: {len(left)} of "
                f"{len(sources)} sources: " + " ".join(left[:8]) + (" ..." if len(left) > 8 else ""))
        if found:
            sys.stderr.write("".join(found.splitlines(keepends=True)[:80]))
            raise StepFailed(f"FAILED: bug patterns (all of them: {self.file('clang-tidy.txt')})")
        return {"sources": len(sources) - len(left)}

    # The end.

    def report(self):
        """Where the time went, in a few lines; all of it goes to timings.json."""
        rows = self.steps.rows
        dearest = sorted(self.results, key=lambda r: -r["seconds"])[:20]
        if not self.options.changed:
            self.history.update("steps", {r["step"]: r["seconds"] for r in rows if r["finished"]})
        self.history.update("tests", {r["test"]: r["seconds"] for r in self.results if r["verdict"] == "passed"})
        self.history.save()
        with open(self.file("timings.json"), "w", encoding="utf-8") as file:
            json.dump({"steps": rows, "dearest": dearest, "tests": self.results}, file, indent=1)
        total = sum(r["seconds"] for r in rows)
        say(f"where {minutes(total)} min went (all of it: {self.file('timings.json')}):")
        for r in rows:
            cache = f", {r['cached']} of {r['compiled']} files from the compiler cache" if r.get("compiled") else ""
            idle = f", cores {round(100 * r['idle'])} % idle" if "idle" in r else ""
            say(f"  {minutes(r['seconds']):>6}  {r['step']}{idle}{cache}")
        for suite, prefix in (("release", ""), ("asan", "asan."), ("tsan", "tsan.")):
            of = [r for r in self.results if r["test"].startswith(("asan.", "tsan.")) == bool(prefix)
                  and r["test"].startswith(prefix)]
            if of:
                say(f"  {minutes(sum(r['seconds'] for r in of)):>6}  the {len(of)} tests of {suite}, one after the other")
        say("  dearest: " + ", ".join(f"{r['test']} {r['seconds']:.0f} s" for r in dearest[:5] if r["seconds"] >= 1))


def main():
    parser = argparse.ArgumentParser(add_help=False)
    for flag in ("--quick", "--changed", "--resume", "--tidy"):
        parser.add_argument(flag, action="store_true")
    parser.add_argument("--packages-seconds", type=float, default=0.0)
    top = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
    check = Check(top, parser.parse_args())
    failure = None
    try:
        status = check.run()
    except StepFailed as error:
        failure, status = error, 1
    except KeyboardInterrupt:
        failure, status = "interrupted; tools/test --resume goes on", 130
    check.report()
    for line in check.skipped_suites:
        say(line)
    if failure:
        say(failure)
    # ctest's own summary is the last thing said.
    if check.suite:
        print(check.suite.summary(), end="", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
