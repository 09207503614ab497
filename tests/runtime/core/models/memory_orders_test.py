"""Checks by the model checker Spin that the memory orders written in the code are enough, on every processor that C++
knows: each model beside this file is run with the orders that are read from the source, and must have no error; then
with each of them weakened to relaxed, which must be found unless the table below says that it may be.

  python3 memory_orders_test.py SOURCE FOLDER     exit status 77: skipped, spin is not installed
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ACQUIRES = {"acquire", "acq_rel", "seq_cst"}
RELEASES = {"release", "acq_rel", "seq_cst"}

# The names of an operation in the model, and how it is written in the code; {} stands for its order.
EDGE = {
    "runtime/core/ring.h": {
        "CLAIM_ACQUIRES": "producer_.limit = freed_.load({})",
        "PUBLISH_RELEASES": "published_.store(++producer_.tail, {})",
        "FRONT_ACQUIRES": "consumer_.seen = published_.load({})",
        "FREE_RELEASES": "freed_.store(head, {})",
    },
    "runtime/core/edge.h": {
        "PROMISED_ACQUIRES": "from_nanoseconds(promised_.load({}))",
        "PROMISE_RELEASES": "promised_.store(to_nanoseconds(t), {})",
    },
    "runtime/core/doorbell.h": {
        "RING_ACQUIRES RING_RELEASES": "count_.fetch_add(1, {})",
        "LISTEN_ACQUIRES": "listen() const { return count_.load({}); }",
        "WAIT_ACQUIRES": "count_.wait(heard, {})",
    },
}
LATEST_VALUE = {
    "runtime/core/latest_value.h": {
        "PUBLISH_ACQUIRES PUBLISH_RELEASES": "waiting_.exchange(back_.index | unread_bit, {})",
        "LOOK_ACQUIRES": "(waiting_.load({}) & unread_bit)",
        "LATEST_ACQUIRES LATEST_RELEASES": "waiting_.exchange(front_.index, {})",
    },
}
DATA_CLOCK = {
    "runtime/core/data_clock.cpp": {
        "BEFORE_ACQUIRES": "before = newest_.load({})",
        "DATA_ACQUIRES": "slot.data.load({})",
        "SPEED_ACQUIRES": "slot.speed.load({})",
        "AFTER_ACQUIRES": "if (newest_.load({}) - before",
        "DATA_RELEASES": "slot.data.store(to_nanoseconds(s.data), {})",
        "SPEED_RELEASES": "slot.speed.store(s.speed, {})",
        "NEWEST_RELEASES": "newest_.store(next, {})",
    },
}
# The model, its operations, its sizes, and the orders that nothing in it needs: who waits for a bell listens to it
# again before he looks for work, and listening acquires.
MODELS = [
    ("edge", EDGE, [{"ITEMS": 3, "BATCH": 1}, {"ITEMS": 3, "BATCH": 2}], {"WAIT_ACQUIRES"}),
    ("latest_value", LATEST_VALUE, [{"VALUES_SENT": 4}], set()),
    ("data_clock", DATA_CLOCK, [{"SCHEDULES": 5}], set()),
]


def orders_in(source: Path, operations: dict) -> dict:
    """Returns 1 or 0 for each name: whether the operation has that order in the code."""
    orders = {}
    for file, written in operations.items():
        text = re.sub(r"\s+", " ", (source / file).read_text())
        for names, operation in written.items():
            pattern = re.escape(operation).replace(r"\{\}", r"std::memory_order_(\w+)")
            found = re.findall(pattern, text)
            if len(found) != 1:
                sys.exit(f"{file} has '{operation}' {len(found)} times, and not once: correct the table of this test")
            for name in names.split():
                orders[name] = int(found[0] in (ACQUIRES if name.endswith("ACQUIRES") else RELEASES))
    return orders


def errors(model: Path, folder: Path, defines: dict) -> tuple:
    """Returns the number of errors of a model (0 or 1), and of the states that were looked at."""
    folder.mkdir(parents=True, exist_ok=True)
    words = [f"-D{name}={number}" for name, number in defines.items()]
    subprocess.run(["spin", "-a", *words, str(model)], cwd=folder, check=True, capture_output=True)
    compiler = ["cc", "-w", "-DCOLLAPSE", "-DSAFETY", "-DVECTORSZ=4096"]
    subprocess.run([*compiler, "-o", "pan", "pan.c"], cwd=folder, check=True)
    said = subprocess.run(["./pan", "-m1000000"], cwd=folder, check=True, capture_output=True, text=True).stdout
    found = re.search(r"errors: (\d+)", said)
    states = re.search(r"(\d+) states, stored", said)
    if found is None or states is None or "error: max search depth too small" in said:
        sys.exit(f"spin did not finish {model.name} with {defines}:\n{said}")
    return int(found[1]), int(states[1])


def main() -> int:
    source, folder = Path(sys.argv[1]), Path(sys.argv[2])
    if shutil.which("spin") is None:
        print("SKIPPED, NOT TESTED: spin is not installed (tools/install-packages test)", file=sys.stderr)
        return 77
    wrong = 0
    for name, operations, sizes, not_needed in MODELS:
        model = Path(__file__).resolve().parent / f"{name}.pml"
        orders = orders_in(source, operations)
        for size in sizes:
            count, states = errors(model, folder, {**orders, **size})
            print(f"{name}, {size}: {states} states, {'an error' if count else 'no error'}", flush=True)
            wrong += count
        for weakened in (order for order, strong in orders.items() if strong):
            count = max(errors(model, folder, {**orders, weakened: 0, **size})[0] for size in sizes)
            expected = weakened not in not_needed
            print(f"{name} without {weakened}: {'found' if count else 'not found'}", flush=True)
            wrong += bool(count) != expected
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main())
