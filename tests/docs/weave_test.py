#!/usr/bin/env python3
"""docs/weave.py on small repositories made here: what each block becomes, and that each kind of staleness is caught.

Run: python3 tests/docs/weave_test.py
"""
import contextlib
import io
import json
import sys
import tempfile
import types
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "docs"))
import weave  # noqa: E402

SHADER = """// Phase functions: how light turns. Units: 1/sr.
// [whole]
float a() {
  // [inside]
  return 1.0;

  // [/inside]
}
// [/whole]
// [open]
// [twice]
int x;
// [/twice]
// [twice]
int y;
// [/twice]
// [hollow]

// [/hollow]
"""
SWEEP = """# chapter: 05
# device: llvmpipe
# driver: Mesa 22.3.6
# software driver: yes
# resolution: 640x360
view,knob:view.steps,gpu_ms_median,relative_rmse
noon,8,41.23456,0.0123456
noon,16,80.06,0.00001234567
sunset,8,12345.678,nan
"""
BENCH = {"chapter": "05", "scene": "noon", "view": "horizon", "device": "llvmpipe", "driver": "Mesa", "software": True,
         "width": 640, "height": 360, "passes": [{"name": "march", "median_ms": 1.23456, "min_ms": 1, "max_ms": 2}],
         "wall_ms": {"median_ms": 3, "min_ms": 2, "max_ms": 4}}
KNOBS = {"chapter": "05", "knobs": [
    {"name": "view.steps", "unit": "steps", "meaning": "samples | ray", "minimum": 1, "maximum": 1024, "initial": 32,
     "ladder": [8, 32]},
    {"name": "rule", "unit": "", "meaning": "quadrature", "minimum": 0, "maximum": 1, "initial": 1,
     "choices": ["left", "midpoint"], "ladder": [0, 1]}]}
HELP = """Usage: welkin_05 [OPTIONS]

Options:
  -h,--help                   Print this
                              and exit

[Option Group: device]
  --gpu N|name                Choose one
"""


class Weave(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.put("shaders/05_sky/phase.glsl", SHADER)
        self.put("chapters/05_sky/main.cpp", "// Draws a sky. More.\nint main() {}\n")
        self.put("chapters/05_sky/CMakeLists.txt", "# Chapter 05.\nwelkin_chapter(NUMBER 05 NAME sky USES rays air)\n")
        self.put("chapters/04_air/main.cpp", "// Air.\n")
        self.put("docs/generated/sweep.csv", SWEEP)
        self.put("docs/generated/bench.json", json.dumps(BENCH))
        self.put("docs/generated/knobs_05.json", json.dumps(KNOBS))
        self.put("docs/generated/options.txt", HELP)
        self.put("docs/generated/test.txt", "ok\n```\n")

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run_weave(self, *options):
        """Exit code and output of weave.py, called and not started: as a program it runs in docs.fresh."""
        out, error = io.StringIO(), io.StringIO()
        with mock.patch.object(sys, "argv", ["weave.py", "--root", str(self.root), *options]), contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            code = weave.main()
        return types.SimpleNamespace(returncode=code, stdout=out.getvalue(), stderr=error.getvalue())

    def page(self, text, name="docs/chapters/05_sky.md"):
        self.put(name, text)

    def woven(self, command):
        """The lines that a block becomes; also that weaving again changes nothing and the check agrees."""
        self.page(f"# Sky\n\n<!-- weave: {command} -->\n<!-- /weave -->\n\nafter\n")
        stale = self.run_weave("--check")
        self.assertEqual(stale.returncode, 1, command)
        self.assertEqual(stale.stderr, f"docs/chapters/05_sky.md:3: stale block '{command}': run docs/weave.py\n")
        done = self.run_weave()
        self.assertEqual((done.returncode, done.stderr), (0, ""), command)
        text = (self.root / "docs/chapters/05_sky.md").read_text(encoding="utf-8")
        self.assertEqual(self.run_weave("--check").returncode, 0)
        self.assertNotIn("wove", self.run_weave().stdout)
        head, tail = f"# Sky\n\n<!-- weave: {command} -->\n\n", "\n\n<!-- /weave -->\n\nafter\n"
        self.assertTrue(text.startswith(head) and text.endswith(tail), text)
        return text[len(head):-len(tail)].split("\n")

    def problem(self, text, expected, name="docs/chapters/05_sky.md"):
        """The check prints exactly one line, which starts with the page and holds `expected`; so does weaving."""
        self.page(text, name)
        for options in (["--check"], []):
            result = self.run_weave(*options)
            self.assertEqual(result.returncode, 1, text)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertRegex(result.stderr, rf"^{name}:\d+: ")
            self.assertIn(expected, result.stderr)
        self.assertEqual((self.root / name).read_text(encoding="utf-8"), text)

    def bad_block(self, command, expected):
        self.problem(f"# Sky\n\n<!-- weave: {command} -->\nkept\n<!-- /weave -->\n", expected)

    # What blocks become

    def test_code_region(self):
        self.assertEqual(self.woven("code shaders/05_sky/phase.glsl region=whole"), [
            "```glsl", "float a() {", "  return 1.0;", "", "}", "```", "",
            "*[`shaders/05_sky/phase.glsl`](../../shaders/05_sky/phase.glsl#L3-L8), lines 3–8*"])

    def test_nested_region_loses_its_indentation(self):
        self.assertEqual(self.woven("code shaders/05_sky/phase.glsl region=inside")[:4], ["```glsl", "return 1.0;", "```", ""])

    def test_whole_file_and_hash_markers(self):
        self.put("cmake/x.cmake", "# [uses]\nset(A 1)\n# [/uses]\n")
        self.assertEqual(self.woven("code cmake/x.cmake"), ["```cmake", "set(A 1)", "```", "",
                                                            "*[`cmake/x.cmake`](../../cmake/x.cmake#L2), line 2*"])

    def test_text_with_backticks_gets_a_longer_fence(self):
        self.assertEqual(self.woven("text docs/generated/test.txt"), ["````text", "ok", "```", "````"])

    def test_knobs(self):
        self.assertEqual(self.woven("knobs 05")[2:], [
            "| `view.steps` | steps | 1 … 1024 | 32 | 8 → 32 | samples \\| ray |",
            "| `rule` | – | `left`, `midpoint` | `midpoint` | `left` → `midpoint` | quadrature |"])

    def test_csv_columns_rows_digits_and_caption(self):
        command = 'csv docs/generated/sweep.csv "columns=view,knob:view.steps=view steps,gpu_ms_median,relative_rmse"'
        self.assertEqual(self.woven(command), [
            "| view | view steps | gpu_ms_median | relative_rmse |", "| --- | ---: | ---: | ---: |",
            "| noon | 8 | 41.23 | 0.01235 |", "| noon | 16 | 80.06 | 1.235e-5 |", "| sunset | 8 | 12346 | nan |", "",
            "*device: llvmpipe · driver: Mesa 22.3.6 · software driver · resolution: 640x360*"])
        rows = self.woven("csv docs/generated/sweep.csv columns=relative_rmse where=view=noon where=knob:view.steps>8")
        self.assertEqual(rows[2:4], ["| 1.235e-5 |", ""])

    def test_bench(self):
        self.assertEqual(self.woven("json docs/generated/bench.json")[2:], [
            "| march | 1.235 | 1 | 2 |", "| wall clock, whole frame | 3 | 2 | 4 |", "",
            "*chapter 05, scene noon, view horizon, 640×360 · llvmpipe · Mesa"
            " · software driver: says nothing about a GPU*"])

    def test_changes(self):
        lines = self.woven("changes 04 05")
        self.assertEqual(lines[0], "Chapter 04 has 1 file, 1 line. Chapter 05 adds 3 files, 23 lines; it uses `rays`, `air`.")
        self.assertEqual(lines[4:], [
            "| [`chapters/05_sky/CMakeLists.txt`](../../chapters/05_sky/CMakeLists.txt) | 2 | Chapter 05. |",
            "| [`chapters/05_sky/main.cpp`](../../chapters/05_sky/main.cpp) | 2 | Draws a sky. |",
            "| [`shaders/05_sky/phase.glsl`](../../shaders/05_sky/phase.glsl) | 19 | Phase functions: how light turns. |"])

    def test_options(self):
        self.assertEqual(self.woven("options")[2:], ["| options | `-h,--help` | Print this and exit |",
                                                     "| device | `--gpu N\\|name` | Choose one |"])

    # Staleness: the source moves on, the page does not

    def test_every_source_that_changes_makes_its_block_stale(self):
        shader = SHADER.replace("1.0", "2.0")
        later = {"code shaders/05_sky/phase.glsl region=whole": ("shaders/05_sky/phase.glsl", shader),
                 "knobs 05": ("docs/generated/knobs_05.json", json.dumps(KNOBS).replace("1024", "512")),
                 "csv docs/generated/sweep.csv": ("docs/generated/sweep.csv", SWEEP.replace("41.23456", "44")),
                 "json docs/generated/bench.json": ("docs/generated/bench.json", json.dumps({**BENCH, "device": "other"})),
                 "text docs/generated/test.txt": ("docs/generated/test.txt", "failed\n"),
                 "changes 04 05": ("chapters/05_sky/main.cpp", "// Draws.\n"),
                 "options": ("docs/generated/options.txt", HELP.replace("Choose", "Take"))}
        for command, (name, text) in later.items():
            with self.subTest(command):
                self.woven(command)
                self.put(name, text)
                result = self.run_weave("--check")
                self.assertEqual(result.returncode, 1)
                self.assertIn(f"05_sky.md:3: stale block '{command}'", result.stderr)

    def test_a_moved_region_and_an_edited_block_are_stale(self):
        command = "code shaders/05_sky/phase.glsl region=inside"
        self.woven(command)
        self.put("shaders/05_sky/phase.glsl", "\n" + SHADER)
        self.assertIn("stale", self.run_weave("--check").stderr)  # the caption's line numbers
        self.woven(command)
        page = self.root / "docs/chapters/05_sky.md"
        page.write_text(page.read_text(encoding="utf-8").replace("return 1.0;", "return 3.0;"), encoding="utf-8")
        self.assertIn("stale", self.run_weave("--check").stderr)

    def test_check_writes_nothing_and_nothing_is_left_beside_a_woven_page(self):
        self.page("<!-- weave: options -->\n<!-- /weave -->\n")
        before = sorted(self.root.rglob("*"))
        self.run_weave("--check")
        self.assertEqual((self.root / "docs/chapters/05_sky.md").read_text(), "<!-- weave: options -->\n<!-- /weave -->\n")
        self.run_weave()
        self.assertEqual(sorted(self.root.rglob("*")), before)

    # What cannot be woven

    def test_bad_blocks(self):
        for command, expected in {
            "code shaders/none.glsl": "cannot read shaders/none.glsl: No such file or directory",
            "code shaders/05_sky/phase.glsl region=gone": "phase.glsl has no region 'gone' (it has: hollow, inside, twice, whole)",
            "code shaders/05_sky/phase.glsl region=open": "phase.glsl has an unclosed region 'open'",
            "code shaders/05_sky/phase.glsl region=twice": "phase.glsl has two regions 'twice'",
            "code shaders/05_sky/phase.glsl region=hollow": "phase.glsl: region 'hollow' is empty",
            "knobs 09": "cannot read docs/generated/knobs_09.json",
            "csv docs/generated/sweep.csv columns=view,gone": "sweep.csv has no column 'gone' (it has: view, knob:view.steps",
            "csv docs/generated/sweep.csv where=view=moon": "sweep.csv has no row where view=moon",
            "json docs/generated/sweep.csv": "docs/generated/sweep.csv is not JSON",
            "json docs/generated/knobs_05.json": "knobs_05.json lacks 'passes'",
            "changes 04 06": "no file of chapter 06",
            "changes 03 04": "no welkin_chapter(NUMBER 04 …)",
            "options docs/generated/test.txt": "docs/generated/test.txt lists no option",
            "picture x.png": "unknown kind of block",
            "code": "cannot weave 'code'",
            'text "x': "cannot weave",
        }.items():
            with self.subTest(command):
                self.bad_block(command, expected)

    def test_times_without_a_device_are_refused(self):
        self.put("docs/generated/sweep.csv", SWEEP.replace("# device: llvmpipe\n", ""))
        self.bad_block("csv docs/generated/sweep.csv", "docs/generated/sweep.csv shows times but its '#' lines do not name")

    def test_markers(self):
        self.problem("<!-- weave: options -->\n", ":1: weave block 'options' is not closed")
        self.problem("a\n<!-- /weave -->\n", ":2: malformed or unmatched weave marker")
        self.problem("<!-- weave options -->\n", ":1: malformed or unmatched weave marker")
        self.put("docs/generated/evil.txt", "<!-- /weave -->\n")
        self.bad_block("text docs/generated/evil.txt", "'text docs/generated/evil.txt' would bring in a weave marker")

    # Pages

    def test_code_pasted_by_hand(self):
        for language in ("cpp", "c++", "glsl", "cmake", ""):
            with self.subTest(language):
                self.problem(f"# A\n\n```{language}\nint x;\n```\n", f":3: fence '{language}' pasted by hand")
        self.problem("```bash\nls\n", ":1: code fence is not closed")
        self.page("# A\n\n```bash\n<!-- weave: shown, not woven -->\n[x](gone.md)\n```\n\n~~~toml\nversion = 1\n~~~\n")
        self.assertEqual(self.run_weave("--check").returncode, 0)

    def test_dead_links_anchors_and_figures(self):
        self.page("# The *other* page: `x`, 2nd\n\n## Twice\n\n## Twice\n\n```bash\n# not a heading\n```\n", "docs/other.md")
        for text, expected in {
            "a\n[x](gone.md)\n": ":2: dead link gone.md",
            "![x](../pictures/gone.png)\n": ":1: missing figure ../pictures/gone.png",
            "[x](../other.md#gone)\n": ":1: dead anchor ../other.md#gone",
            "[x](../other.md#not-a-heading)\n": "dead anchor",
            "[x](#gone)\n": ":1: dead anchor #gone",
            "[x]: ../gone.md\n": ":1: dead link ../gone.md",
            '<img src="gone.svg">\n': ":1: missing figure gone.svg",
            "[![x](gone.png)](../other.md)\n": "missing figure gone.png",
            "[x](/other.md)\n": "must be relative and stay in the repository",
            "[x](../../../x.md)\n": "must be relative and stay in the repository",
        }.items():
            with self.subTest(text):
                self.problem(text, expected)
        self.page("[a](../other.md#the-other-page-x-2nd) [b](../other.md#twice-1) [c](https://example.org) "
                  "[d](../../shaders/05_sky/phase.glsl#L1-L2) `[e](gone.md)` $p[f](\\nu)$ <!-- [g](gone.md) -->\n")
        self.assertEqual(self.run_weave("--check").stderr, "")
        self.problem("[x](docs/gone.md)\n", ":1: dead link docs/gone.md", "README.md")


if __name__ == "__main__":
    unittest.main()
