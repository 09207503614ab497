#!/usr/bin/env python3
"""Fails on a link between the project's Markdown pages that leads nowhere, and on an equation that code and page do
not both have.

    page_links.py ROOT

A link is to a file or folder from the page's own folder; after # stands a heading of the page it leads to, as
GitHub writes it: lower case, spaces to dashes, all other signs left out. A METHOD.md numbers its equations, (1) at
the beginning of a line; the code below its folder names each number: `(1) of METHOD.md`.
"""
import os
import re
import sys

LINK = re.compile(r"\[[^\]\[]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)
EQUATION = re.compile(r"^\((\d+)\) ", re.MULTILINE)
NAMED = re.compile(r"((?:\(\d+\)(?:, | and )?)+) of METHOD\.md")
NOT_OURS = re.compile(r"^(build|\..*)$")  # folders at the root


def pages(root):
    for where, folders, files in os.walk(root):
        folders[:] = [f for f in folders if f != "node_modules" and not (where == root and NOT_OURS.match(f))]
        yield from (os.path.join(where, name) for name in files if name.endswith(".md"))


def text_of(page):
    with open(page, encoding="utf-8") as file:
        return CODE.sub("", file.read())


def anchors(page):
    headings = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", h) for h in HEADING.findall(text_of(page)))
    return {re.sub(r"[^\w\- ]", "", h.strip().lower()).replace(" ", "-") for h in headings}


def broken(page):
    for link in LINK.findall(text_of(page)):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(target):
            yield f"{link}: there is no such file"
        elif anchor and anchor not in anchors(target):
            yield f"{link}: the page has no such heading"


def equations_apart(page):
    """The numbers that a METHOD.md or the code below its folder has alone."""
    with open(page, encoding="utf-8") as file:
        numbered = EQUATION.findall("\n".join(CODE.findall(file.read())))
    named = set()
    for where, _, files in os.walk(os.path.dirname(page)):
        for name in files:
            if name.endswith((".h", ".cpp")):
                with open(os.path.join(where, name), encoding="utf-8") as file:
                    named.update(n for group in NAMED.findall(file.read()) for n in re.findall(r"\d+", group))
    if numbered != [str(n) for n in range(1, len(numbered) + 1)]:
        yield "the equations are not numbered from (1) in their order"
    yield from (f"no code names equation ({n})" for n in numbered if n not in named)
    yield from (f"code names equation ({n}), which the page does not have" for n in named - set(numbered))


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit(__doc__)
    root = os.path.abspath(sys.argv[1])
    found = [f"{os.path.relpath(page, root)}: {what}" for page in sorted(pages(root)) for what in broken(page)]
    found += [f"{os.path.relpath(page, root)}: {what}" for page in sorted(pages(root))
              if os.path.basename(page) == "METHOD.md" for what in equations_apart(page)]
    if found:
        sys.exit("\n".join(found))
    print(f"{sum(1 for _ in pages(root))} pages lead somewhere")


if __name__ == "__main__":
    main()
