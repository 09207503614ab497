#!/usr/bin/env python3
"""Writes msgs/lcm/CHANNELS.md: each channel, and each field of its messages as the .lcm files describe it.

    channel_page.py ROOT [--check]

ROOT is the source tree. With --check nothing is written, and the exit status is 1 where the page would change.
"""
import pathlib
import re
import sys

INTRODUCTION = """# The channels and their messages

Made by `tools/packaging/channel_page.py` from the `.lcm` files here and from [the graph](../../runtime/vehicle/GRAPH.md#channels); a test
compares them. Units are SI and angles are in radians, unless a field says otherwise. `enu` is east, north and up of a plane that touches the
WGS84 ellipsoid at the origin that the message gives; the body's axes are forward, left and up. `stamp_ns` is the moment of the measurement.
[Listeners](../../tests/examples/README.md#a-listener) in C, C++, Python and Java show how a channel is read.

"""


def channels_of(graph):
    """The rows of the graph's table of channels: name, type, from, shows, rate."""
    table = graph.split("## Channels\n")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in table.splitlines() if line.startswith("| `")]
    return [row[:5] for row in rows]


class Message:
    """One .lcm file: what stands above the struct, its fields with their comments, and its constants."""

    def __init__(self, path):
        self.name, self.fields, self.constants, about = path.stem, [], [], []
        inside = False
        for line in path.read_text().splitlines():
            code, _, comment = (part.strip() for part in line.partition("//"))
            if code.startswith("struct"):
                inside = True
            elif not inside and comment:
                about.append(comment)
            elif inside and code.startswith("const"):
                self.constants.append(re.sub(r"const \w+\s+", "", code).rstrip(";"))
            elif self.constants and code and code != "}":  # the constants go on
                self.constants[-1] += " " + code.rstrip(";")
            elif inside and (match := re.fullmatch(r"(\w+)\s+(\w+)((?:\[\w+\])*);", code)):
                kind, field, size = match.groups()
                self.fields.append([field + size, kind, comment])
            elif comment and self.fields:
                self.fields[-1][2] += " " + comment  # it goes on, on a line of its own
        self.about = " ".join(about)

    def page(self, known):
        rows = [f"| `{field}` | {link(kind, known)} | {meaning.replace('|', chr(92) + '|')} |\n"
                for field, kind, meaning in self.fields]
        text = f"### {self.name}\n\n" + (self.about + "\n\n" if self.about else "")
        text += "| field | type | meaning |\n|---|---|---|\n" + "".join(rows) + "\n"
        if self.constants:
            text += "Constants: " + "; ".join(f"`{c}`" for c in self.constants) + ".\n\n"
        return text


def link(kind, known):
    return f"[{kind}](#{kind})" if kind in known else kind


def page_of(root):
    messages = [Message(path) for path in sorted((root / "msgs/lcm").glob("*.lcm"))]
    known = {message.name for message in messages}
    text = INTRODUCTION + "| channel | message | from | shows | rate |\n|---|---|---|---|---|\n"
    for name, kind, *rest in channels_of((root / "runtime/vehicle/GRAPH.md").read_text()):
        if kind not in known:
            sys.exit(f"channel_page.py: the graph's channel {name} has messages {kind}, and msgs/lcm has no such file")
        text += "| " + " | ".join([name, link(kind, known), *rest]) + " |\n"
    return text + "\n## Messages\n\n" + "".join(message.page(known) for message in messages).rstrip("\n") + "\n"


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--check"]):
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    page, text = root / "msgs/lcm/CHANNELS.md", page_of(root)
    if sys.argv[2:] and page.read_text() != text:
        sys.exit(f"{page} is not what the definitions say; run {sys.argv[0]} {root}")
    if not sys.argv[2:]:
        page.write_text(text)


if __name__ == "__main__":
    main()
