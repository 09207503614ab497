"""Which tests a change can affect, the nearest first, as many as a short run has time for."""
import os

import builds
import change
from steps import say
from suite import Suite

TEST_SECONDS = 45.0  # the tests of a short run, one after the other
LINK_SECONDS = 2.0   # what one more program to build is taken to cost
UNKNOWN_SECONDS = 1.0  # what a test is taken to cost that has not run yet


class AffectedTests:
    def __init__(self, top, steps, changed, seconds):
        self.build = os.path.join(top, "build", "release")
        self.programs, self.chosen, self.left_out = [], set(), {}
        say(f"{len(changed)} files differ: " + " ".join(changed[:8]) + (" ..." if len(changed) > 8 else ""))
        if not os.path.exists(os.path.join(self.build, ".ninja_deps")):
            say("nothing is built yet: this once, everything is")
            builds.build(steps, top, "release")
        graph = change.Graph(top, self.build)
        groups, self.unaffected = self.group(top, graph, changed)
        spent = 0.0
        for _, program, names in sorted(groups):
            link = LINK_SECONDS
            for name in sorted(names, key=lambda n: seconds.get(n, UNKNOWN_SECONDS)):
                cost = link + seconds.get(name, UNKNOWN_SECONDS)
                if spent + cost > TEST_SECONDS:
                    self.left_out.setdefault(program, []).append(name)
                    continue
                spent += cost
                link = 0.0
                self.chosen.add(name)
                if program.startswith("bin/") and program not in self.programs:
                    self.programs.append(program)
        say(f"{len(self.chosen)} tests are affected and near")

    def group(self, top, graph, changed):
        """(distance, program, tests) of what is affected, and how many tests are not."""
        by_program = {}
        for test in Suite(os.path.join(top, "build", "check"), [self.build], "").tests():
            words = [os.path.relpath(w, self.build) for w in test.get("command", []) if w.startswith(top)]
            program = next((w for w in words if w.startswith("bin/")), words[0] if words else test["name"])
            names, files = by_program.setdefault(program, ([], set()))
            names.append(test["name"])
            files.update(words)
        groups, unaffected = [], 0
        for program, (names, words) in by_program.items():
            files = {os.path.relpath(os.path.normpath(os.path.join(self.build, w)), top) for w in words}
            for word in words:
                if word.startswith("bin/"):
                    files |= graph.files_of(word)
            sources = [f for f in files if f.startswith("tests/") and os.path.isfile(os.path.join(top, f))]
            hit = (files & set(changed)) | change.data_below(top, changed, files)
            hit |= change.mentioned_in(top, changed, sources)
            if hit or program.startswith("../../tests/structure"):
                own = [os.path.dirname(s) for s in sources if "_test." in os.path.basename(s)]
                folder = max(own, key=own.count) if own else "tests"
                groups.append((change.distance(folder, changed) if changed else 0, program, names))
            else:
                unaffected += len(names)
        return groups, unaffected

    def say_what_was_not_run(self):
        for program, names in self.left_out.items():
            say(f"NOT RUN, though affected: {len(names)} tests of {os.path.basename(program)}")
        say(f"NOT RUN, not affected: {self.unaffected} tests; not run either: all tests under sanitizers")
