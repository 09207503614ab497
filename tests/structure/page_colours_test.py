#!/usr/bin/env python3
"""Tests the checker of colours itself on synthetic trees."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECKER = Path(__file__).resolve().parent / "page_colours.py"
GOOD = {
    "tools/web/design/tokens.css": ":root { --truth: light-dark(#15181b, #f2f3f4); }\n",
    "tools/web/design/base.css": "td { color: var(--truth); border: 0 }\n",
    "tools/web/src/page.css": "/* not #fff */ #map { --own: 3px; top: var(--own); white-space: normal }\n",
    "tools/web/src/map.ts": "draw(ink('truth')); // neither red nor #123456\nconst c = `rgb(from ${ink('truth')} r g b / 0.3)`;\n",
    "tools/fleet/page.html": "<i style='color: var(--truth)'>&#39;red&#39; is a word</i>\n",
    "tools/report/report.cpp": '#include "tools/web/page.h"\nauto s = "var(--truth)";\n',
    "tools/vehicle/drawing.cpp": 'auto fill = "#8888ff";  // no page\n',
}


class Checker(unittest.TestCase):
    def check(self, **changes):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**GOOD, **changes}.items():
                file = Path(folder) / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            run = subprocess.run([sys.executable, CHECKER, folder], capture_output=True, text=True)
            return run.returncode, run.stdout + run.stderr

    def test_a_page_of_tokens_passes(self):
        self.assertEqual(self.check(), (0, ""))

    def test_each_kind_of_colour_is_found_with_its_place(self):
        for colour in ("#fff", "#1f77b4", "rgb(1, 2, 3)", "rgba(1,2,3,.5)", "hsl(220 75% 42%)", "red", "White"):
            status, said = self.check(**{"tools/web/src/page.css": f"p {{\n  color: {colour};\n}}\n"})
            self.assertEqual(status, 1, colour)
            self.assertIn("tools/web/src/page.css:2: the colour '", said)
        for name, text in (("tools/web/src/map.ts", 'c.fillStyle = "#808080";\n'),
                           ("tools/fleet/page.html", "<i style='color: #123456'>\n"),
                           ("tools/report/report.cpp", '#include "tools/web/html.h"\nauto s = "fill:#abcdef";\n'),
                           ("tools/web/design/base.css", "a { color: #123 }\n")):
            self.assertEqual(self.check(**{name: text})[0], 1, name)

    def test_a_token_that_is_not_there_is_named(self):
        status, said = self.check(**{"tools/web/src/page.css": "p { color: var(--c0); }\n"})
        self.assertEqual(status, 1)
        self.assertIn("--c0 is no token", said)


if __name__ == "__main__":
    unittest.main()
