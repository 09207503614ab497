#!/usr/bin/env python3
"""Keeps the tables of CONFIGURATION.md as maploop.toml has the keys.

    configuration_page.py MAPLOOP.TOML PAGE            rewrites what stands below the page's mark
    configuration_page.py MAPLOOP.TOML PAGE --check    status 1 where that would change anything
"""
import re
import sys

MARK = "<!-- Below: made from maploop.toml by tools/packaging/configuration_page.py -->\n"
KEY = re.compile(r'^([a-z_0-9]+) = ("[^"]*"|\{[^}]*\}|\[[^\]]*\]|[^# ]+)(?:  # (.*))?$')
KINDS = ((r'"', "text"), (r"true|false", "true or false"), (r"\[", "list"), (r"\{", "table"),
         (r"-?\d+$", "integer"), (r"", "number"))


def kind(value):
    return next(name for pattern, name in KINDS if re.match(pattern, value))


def cell(text):
    return text.replace("|", "\\|")


def tables(toml):
    """(name, what its comment says, [(key, value, comment)]) of each table, the top level first."""
    found = [("", "", [])]
    said = []
    for number, line in enumerate(toml.splitlines(), 1):
        key = KEY.match(line)
        if line.startswith("#"):
            said.append(line[1:].strip())
        elif line.startswith("["):
            found.append((line.strip("[]"), " ".join(said), []))
            said = []
        elif key:
            name, value, comment = key.groups()
            found[-1][2].append((name, value, " ".join([*said, comment or ""]).strip()))
            said = []
        elif line:
            sys.exit(f"maploop.toml:{number}: not understood: {line}")
        elif not found[-1][2]:
            said = []  # what the file's head says of itself
    return found


def page(toml):
    lines = []
    for name, what, keys in tables(toml):
        lines += [f"\n## `[{name}]`\n" if name else "\n## At the top level\n"]
        lines += [what + "\n"] if what else []
        lines += ["| key | default | kind | what |", "|---|---|---|---|"]
        lines += [f"| `{key}` | `{cell(value)}` | {kind(value)} | {cell(comment)} |" for key, value, comment in keys]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--check"]):
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        toml = file.read()
    with open(sys.argv[2], encoding="utf-8") as file:
        old = file.read()
    head, mark, _ = old.partition(MARK)
    if not mark:
        sys.exit(f"{sys.argv[2]} has no line: {MARK}")
    new = head + mark + page(toml)
    if sys.argv[3:]:
        if new != old:
            sys.exit("CONFIGURATION.md is not what maploop.toml says; run\n  tools/packaging/configuration_page.py "
                     "runtime/vehicle/maploop.toml runtime/vehicle/CONFIGURATION.md")
        return
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(new)


if __name__ == "__main__":
    main()
