#!/usr/bin/python3
"""Fails on a colour of a page that is not of the design, and on a token that the design does not have.

    page_colours.py ROOT

Colours are named in tools/web/design only (tools/web/README.md). Sheets, scripts and HTML are looked at, and sources
that make pages.
"""
import re
import sys
from pathlib import Path

NAMES = "black|white|red|green|blue|gr[ae]y|orange|yellow|purple|pink|brown|cyan|magenta|navy|teal|silver|gold"
COLOUR = re.compile(r"#(?:[0-9a-f]{8}|[0-9a-f]{6}|[0-9a-f]{3,4})\b(?![\w-])|\b(?:rgba?|hsla?|hwb|lab|lch|oklab|oklch)\((?!from )"
                    rf"|(?<=[:\s\"'`])(?:{NAMES})(?=\s*[;}}\"'`])", re.IGNORECASE)
TOKEN = re.compile(r"var\(--([\w-]+?)\s*[,)]")
DEFINED = re.compile(r"--([\w-]+)\s*:")
COMMENT = re.compile(r"/\*.*?\*/|(?<![:\w])//[^\n]*", re.DOTALL)


def pages(root):
    web = root / "tools/web"
    yield from sorted([*web.glob("design/base.css"), *web.glob("src/*.css"), *web.glob("src/*.ts")])
    yield from sorted(root.glob("tools/**/*.html"))
    yield from (f for f in sorted(root.glob("tools/**/*.cpp")) if '#include "tools/web/' in f.read_text())


def findings(file, tokens):
    text = COMMENT.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), file.read_text())
    known = tokens | set(DEFINED.findall(text)) | {"key"}
    for number, line in enumerate(text.splitlines(), 1):
        for match in COLOUR.finditer(line):
            if line[max(0, match.start() - 1):match.start()] != "&":  # &#39; is a character
                yield number, f"the colour '{match[0]}': use a token of tools/web/design/tokens.css, or add one there"
        for name in TOKEN.findall(line):
            if name not in known:
                yield number, f"--{name} is no token of tools/web/design/tokens.css"


def main(root):
    tokens = set(DEFINED.findall((root / "tools/web/design/tokens.css").read_text()))
    found = [(f.relative_to(root), n, what) for f in pages(root) for n, what in findings(f, tokens)]
    for file, number, what in found:
        print(f"{file}:{number}: {what}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
