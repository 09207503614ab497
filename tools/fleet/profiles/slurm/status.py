#!/usr/bin/python3
"""Prints what became of a Slurm job, for Snakemake: success, failed or running.

    status.py JOB

It asks the controller, so that no accounting is needed. A controller that does not answer is asked again later; a
job that it has forgotten has ended long ago, and whether its result is there is what counts.
"""
import re
import subprocess
import sys

ENDED = {"FAILED", "CANCELLED", "NODE_FAIL", "TIMEOUT", "OUT_OF_MEMORY", "BOOT_FAIL", "DEADLINE", "PREEMPTED"}


def status(answer):
    state = re.search(r"\bJobState=(\w+)", answer.stdout)
    if state:
        return "success" if state[1] == "COMPLETED" else "failed" if state[1] in ENDED else "running"
    return "failed" if "Invalid job id" in answer.stderr else "running"


if __name__ == "__main__":
    print(status(subprocess.run(["scontrol", "-o", "show", "job", sys.argv[1]], capture_output=True, text=True)))
