"""What a change can affect: by ninja's graph of sources, headers and libraries, and by where data files lie."""
import os
import subprocess
import tempfile


def output(command, top, **options):
    return subprocess.run(command, cwd=top, capture_output=True, text=True, check=True, **options).stdout


def tree(top):
    """The name git gives to the files as they are now, committed or not; None outside a checkout."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "GIT_INDEX_FILE": os.path.join(folder, "index")}
        try:
            output(["git", "read-tree", "HEAD"], top, env=environment)
            output(["git", "add", "--all"], top, env=environment)
            return output(["git", "write-tree"], top, env=environment).strip()
        except (OSError, subprocess.CalledProcessError):
            return None


def changed_files(top, before, now):
    return output(["git", "diff", "--name-only", "--no-renames", before, now], top).split("\n")[:-1]


def base(top, green):
    """The commit to compare with: `green`, which passed, where it is an ancestor; else the one before HEAD, or None."""
    for commit in (green, "HEAD~1"):
        if commit and subprocess.run(["git", "merge-base", "--is-ancestor", commit, "HEAD"], cwd=top, check=False,
                                     capture_output=True).returncode == 0:
            return output(["git", "rev-parse", commit + "^{tree}"], top).strip()
    return None


class Graph:
    """The files that each built program depends on, of a build folder whose build ninja has recorded."""

    def __init__(self, top, build):
        self.top, self.build = top, build
        self.read_by = {}  # object -> the files that the compiler read for it
        current = None
        for line in output(["ninja", "-t", "deps"], build).splitlines():
            if line.startswith(" "):
                self.read_by[current].add(self.relative(line.strip()))
            elif line:
                current = line.split(":")[0]
                self.read_by[current] = set()

    def relative(self, path):
        """A path below the root of the checkout, from there; any other as it is."""
        whole = os.path.normpath(os.path.join(self.build, path))
        return os.path.relpath(whole, self.top) if whole.startswith(self.top + os.sep) else whole

    def files_of(self, program):
        """Every file that decides what the program does, by the graph."""
        files = set()
        for line in output(["ninja", "-t", "inputs", program], self.build).splitlines():
            files.add(self.relative(line))
            files |= self.read_by.get(line, set())
        return files


def data_below(top, changed, files):
    """Those of the changed files that no compiler reads, such as rules and pages, but whose folder has code of
    which `files` has some: what that code does may depend on them."""
    folders = {os.path.dirname(f) for f in files if f.endswith((".h", ".cpp"))}
    found = set()
    for name in changed:
        if name.endswith((".h", ".cpp", ".md")):
            continue
        folder = os.path.dirname(name)
        while folder and not os.path.exists(os.path.join(top, folder, "CMakeLists.txt")):
            folder = os.path.dirname(folder)
        if any(f == folder or f.startswith(folder + "/") for f in folders):
            found.add(name)
    return found


def mentioned_in(top, changed, source_files):
    """Those of the changed files whose name a test's source mentions: it reads them."""
    texts = []
    for name in source_files:
        with open(os.path.join(top, name), encoding="utf-8", errors="replace") as file:
            texts.append(file.read())
    return {name for name in changed if any(os.path.basename(name) in text for text in texts)}


def distance(test_folder, changed):
    """How far a test is from a change: tests mirror the tree, so folders that share their beginning are near."""
    def parts(path):
        return [p for p in path.split("/") if p and p != "tests"]

    def apart(a, b):
        same = 0
        while same < min(len(a), len(b)) and a[same] == b[same]:
            same += 1
        return len(a) + len(b) - 2 * same

    return min(apart(parts(test_folder), parts(os.path.dirname(name))) for name in changed)
