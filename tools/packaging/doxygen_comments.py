#!/usr/bin/python3
"""Prints a header as Doxygen reads it: its comments are documentation, and their text is plain.

  doxygen_comments.py HEADER

A comment behind several variables of one declaration belongs to each of them.
"""

import re
import sys

SEVERAL = re.compile(r"^( +)((?:const )?[\w:]+(?:<[^;=]*>)?) (\w+(?: = [^;,()]+|\{\})?(?:, \w+(?: = [^;,()]+|\{\})?)+);(.*)$")


def escaped(text):
    return re.sub(r"([<>\\#&@])", r"\\\1", text)


def documented(lines):
    """Yields the lines with Doxygen's marks."""
    above = []  # the comment that the next declaration has
    for line in lines:
        own = re.match(r"^( *)//(?: (.*))?$", line)
        if own:
            above.append(f"{own[1]}/// {escaped(own[2] or '')}")
            yield above[-1]
            continue
        code, mark, comment = line.partition("  // ")
        comment = f" ///< {escaped(comment)}" if mark else ""
        several = SEVERAL.match(code)
        if several:
            indent, kind, names, rest = several.groups()
            for i, name in enumerate(names.split(", ")):
                if i > 0:
                    yield from above
                yield f"{indent}{kind} {name};{comment}"
        else:
            yield code + comment
        above = []


def main():
    with open(sys.argv[1], encoding="utf-8") as header:
        for line in documented(header.read().splitlines()):
            print(line)


main()
