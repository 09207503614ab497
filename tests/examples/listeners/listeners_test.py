#!/usr/bin/env python3
"""Each example listener prints the states that are sent.

    listeners_test.py PUBLISHER CPP_TYPES TYPES

PUBLISHER sends one message of every type on the vehicle's channels. CPP_TYPES is the folder of the C++
message types, and TYPES has those of C, Python and Java. Exit status 77: skipped, with the reason.
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, "../.."))
import own_network

PATIENCE = 60.0  # s, for the first state
LCM_JAR = "/usr/share/java/lcm.jar"
STATE = re.compile(r"\d+\.\d{3} s: east -?\d+\.\d\d m, north -?\d+\.\d\d m, azimuth -?\d+\.\d{4} rad")


def made(cpp_types, types, folder):
    """Compiles the examples as their first lines say. Returns the commands that start them."""
    c, cpp, java = (os.path.join(folder, name) for name in ("c", "cpp", "java"))
    for command in (
            ["cc", "-I", f"{types}/c", f"{HERE}/listener.c", *glob.glob(f"{types}/c/*.c"), "-llcm", "-o", c],
            ["c++", "-I", cpp_types, f"{HERE}/listener.cpp", "-llcm", "-o", cpp],
            ["javac", "-cp", f"{LCM_JAR}:{types}/java", "-d", java, f"{HERE}/Listener.java"]):
        subprocess.run(command, check=True, timeout=300)
    return {"C": [c], "C++": [cpp], "Python": [sys.executable, f"{HERE}/listener.py"],
            "Java": ["java", "-Djava.net.preferIPv4Stack=true", "-cp", f"{LCM_JAR}:{java}", "Listener"]}


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    publisher, cpp_types, types = sys.argv[1:]
    missing = [tool for tool in ("ip", "unshare", "setpriv", "timeout", "java", "javac") if shutil.which(tool) is None]
    if missing:
        own_network.skip(f"not installed: {', '.join(missing)}; run tools/install-packages watch test")
    own_network.enter()
    os.environ.pop("LCM_DEFAULT_URL", None)
    os.environ["PYTHONPATH"] = f"{types}/python"
    with tempfile.TemporaryDirectory() as folder, own_network.Children() as children:
        commands = made(cpp_types, types, folder)
        children.start(publisher, "500")
        for language, command in commands.items():
            listener = children.start("timeout", str(PATIENCE), *command, stdout=subprocess.PIPE, text=True)
            line = listener.stdout.readline().strip()
            if not STATE.fullmatch(line):
                sys.exit(f"FAILED: the listener in {language} printed {line!r} and no state")
            print(f"{language}: {line}")


if __name__ == "__main__":
    main()
