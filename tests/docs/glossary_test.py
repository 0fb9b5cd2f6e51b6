#!/usr/bin/env python3
"""Every name in the glossary's "in the code" columns stands in the sources as a word, so that a renamed one is noticed.

Run: python3 tests/docs/glossary_test.py
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KINDS = {".cpp", ".hpp", ".h", ".glsl", ".comp", ".frag", ".vert"}


def words():
    text = "\n".join(path.read_text(encoding="utf-8") for top in ("common", "shaders", "chapters")
                     for path in (ROOT / top).rglob("*") if path.suffix in KINDS)
    return set(re.findall(r"(?:--)?\w[\w.-]*\w|\w", text)) | set(re.findall(r"\w+", text))


def names(text):
    """(line, name) for each back-quoted name in a column headed "in the code"."""
    column = None
    for number, line in enumerate(text.split("\n"), 1):
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            column = None
        elif "in the code" in cells:
            column = cells.index("in the code")
        elif column is not None:
            yield from ((number, name) for name in re.findall(r"`([^`]+)`", cells[column]))


class Glossary(unittest.TestCase):
    def test_names_are_read_from_the_right_column(self):
        page = "| a | in the code |\n|---|---|\n| `x` | `y`, `--z` |\n\n| `w` | `v` |\n"
        self.assertEqual(list(names(page)), [(3, "y"), (3, "--z")])

    def test_every_name_stands_in_the_sources(self):
        found = list(names((ROOT / "docs/glossary.md").read_text(encoding="utf-8")))
        self.assertGreater(len(found), 30)
        known = words()
        gone = [f"docs/glossary.md:{line}: no '{name}' in common/, shaders/ or chapters/" for line, name in found if name not in known]
        self.assertEqual(gone, [])


if __name__ == "__main__":
    unittest.main()
