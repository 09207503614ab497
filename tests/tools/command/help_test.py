#!/usr/bin/env python3
"""Each command's help begins with examples, whose options it has, and ends within 80 columns.

    help_test.py MAPLOOP
"""
import re
import subprocess
import sys
import unittest

MAPLOOP = sys.argv.pop(1)


def help_of(words):
    done = subprocess.run([MAPLOOP, *words, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


def commands(words=()):
    text = help_of(words)
    yield words, text
    listed = re.search(r"^Subcommands:\n((?:  .*\n?)*)", text, re.MULTILINE)
    for name in re.findall(r"^  ([a-z][a-z-]*)", listed.group(1), re.MULTILINE) if listed else []:
        yield from commands((*words, name))


class Help(unittest.TestCase):
    def test_every_command_has_examples_before_its_usage(self):
        count = 0
        for words, text in commands():
            with self.subTest(command=" ".join(words)):
                self.assertEqual([line for line in text.splitlines() if len(line) > 80], [])
                before, _, after = text.partition("Usage:")
                examples = re.findall(r"^    maploop (.*)$", before, re.MULTILINE)
                self.assertTrue(1 <= len(examples) <= 3, before)
                for example in examples:
                    self.assertEqual(example.split()[:len(words)], list(words), "the command itself")
                    count += 1
        self.assertGreater(count, 60)

    def test_examples_have_options_that_there_are(self):
        texts = dict(commands())
        for words, text in texts.items():
            for example in re.findall(r"^    maploop (.*)$", text.partition("Usage:")[0], re.MULTILINE):
                parts = tuple(example.split())
                named = max((w for w in texts if parts[:len(w)] == w), key=len)  # "log" shows examples of "log info"
                for option in re.findall(r"(?<= )--?[a-z][a-z-]*", example):
                    self.assertRegex(texts[named], rf"(?m)^  (-.,)?(\S+,)?{option}\b", f"of {example}")


if __name__ == "__main__":
    unittest.main()
