#!/usr/bin/env python3
"""Fails on a link between the project's Markdown pages that leads nowhere.

    page_links.py ROOT

A link is to a file or folder from the page's own folder; after # stands a heading of the page it leads to, as
GitHub writes it: lower case, spaces to dashes, all other signs left out.
"""
import os
import re
import sys

LINK = re.compile(r"\[[^\]\[]*\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#+ +(.*)$", re.MULTILINE)
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


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit(__doc__)
    root = os.path.abspath(sys.argv[1])
    found = [f"{os.path.relpath(page, root)}: {what}" for page in sorted(pages(root)) for what in broken(page)]
    if found:
        sys.exit("\n".join(found))
    print(f"{sum(1 for _ in pages(root))} pages lead somewhere")


if __name__ == "__main__":
    main()
