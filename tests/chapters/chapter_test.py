"""What every chapter must do: its goldens, synchronization validation, counts and bytes, and the faults that must be seen.

Usage: chapter_test.py NN KIND with KIND golden, sync, cost or picture.

What a chapter has is asked of it (its knobs, what it declares of a still frame), not told by its number. A start compiles a
chapter's shaders and fills its tables, so one process draws everything that need not be a process of its own: --golden and
--survey follow one program from scene to scene, and show its last picture to be a fresh program's, bit for bit.
"""
import json
import re
import shutil
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 2)[0] + "/cli")
from welkin_case import ROOT, WelkinCase, read_png  # noqa: E402

NUMBER = "05"


class ChapterCase(WelkinCase):
    known = None

    def knobs(self):
        """All knobs by name, those of the scene included."""
        if ChapterCase.known is None:
            done = self.run_chapter(NUMBER, "--dump", "knobs", "knobs.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            ChapterCase.known = {knob["name"]: knob for knob in json.loads((self.directory / "knobs.json").read_text())["knobs"]}
        return ChapterCase.known

    def has_sky(self):
        return "sun.zenith_deg" in self.knobs()

    def quick(self):
        """A coarse table, where what is asked does not depend on how finely it is gathered."""
        coarse = {"multiple_scattering.iterations": 3, "multiple_scattering.directions": 16}
        return [word for name, value in coarse.items() if name in self.knobs() for word in ("--set", f"{name}={value}")]


class Golden(ChapterCase):
    def goldens(self):
        """The chapter's golden pictures, NN_scene_view.exr."""
        return sorted((ROOT / "tests" / "data" / "golden").glob(f"{NUMBER}_*.exr"))

    def test_standard_views_are_the_goldens(self):
        done = self.run_chapter(NUMBER, "--golden", "check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(sorted(re.findall(r"golden (\S+): (?:identical|close) ", done.stdout)), [file.stem for file in self.goldens()])
        self.assertGreaterEqual(len(self.goldens()), 1)

    def check_one(self, fault):
        """--golden check in a copy of the tree with one golden: that view is drawn, the others are said to be missing."""
        first, *others = self.goldens()
        kept = self.directory / "tree" / "tests" / "data" / "golden"
        shutil.copytree(ROOT / "chapters", self.directory / "tree" / "chapters")
        kept.mkdir(parents=True)
        for file in first, first.with_suffix(".driver"):
            shutil.copy(file, kept)
        done = self.run_chapter(NUMBER, "--golden", "check", "--inject", fault, WELKIN_SOURCE=str(self.directory / "tree"))
        self.assertEqual(done.stdout.count(": missing"), len(others), done.stdout)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        return next(line for line in done.stdout.splitlines() if first.stem in line)

    def test_a_fault_is_seen(self):
        """A wrong constant where there is air, else a NaN."""
        line = self.check_one("wrong-constant" if self.has_sky() else "nan")
        self.assertIn("DIFFERS", line)
        self.assertEqual("NaN" in line, not self.has_sky())


class Sync(ChapterCase):
    def draw(self, *arguments):
        """What is said of three small frames under synchronization validation, and the picture."""
        done = self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--frames", "3", "--validation", "sync", "--output", "p.exr", *arguments)
        return done, (self.directory / "p.exr").read_bytes()

    def test_no_message_and_a_planted_fault_is_caught(self):
        """And why the layer is needed: on a software driver the faulty picture is the same, bit for bit."""
        done, good = self.draw()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("validation:", done.stderr)
        done, faulty = self.draw("--inject", "missing-barrier")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("READ_AFTER_WRITE", done.stderr)
        if ", software)" in done.stdout:
            self.assertEqual(faulty, good)

    def test_probe_is_clean(self):
        if not self.has_sky():
            self.skipTest("no probe in this chapter")
        (self.directory / "rays.csv").write_text("altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg\n0,10,20,30\n")
        done = self.run_chapter(NUMBER, "--probe", "rays.csv", "--probe-out", "out.csv", "--validation", "sync")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Cost(ChapterCase):
    plain = None  # what --explain says of four frames, for all tests

    def explain(self, *arguments):
        """What --explain says of scene noon."""
        done = self.run_chapter(NUMBER, "--headless", "--explain", "--scene", "noon", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def noon(self):
        if Cost.plain is None:
            Cost.plain = self.explain("--size", "320x180", "--frames", "4")
        return Cost.plain

    def test_no_allocation_after_the_first_frame(self):
        self.assertIn("allocations by frames after the first: 0\n", self.noon())

    def test_bytes(self):
        """One float picture and one 8-bit picture, and no more beside them than the chapter declares."""
        extra = int(re.search(r"^  bytes (\d+)$", self.noon(), re.M).group(1))
        bytes_held = int(re.search(r"^  total +(\d+) bytes$", self.noon(), re.M).group(1))
        pictures = 320 * 180 * (16 + 4)
        self.assertGreaterEqual(bytes_held, pictures)
        self.assertLessEqual(bytes_held, pictures + extra)

    def test_passes(self):
        text = self.noon().split("passes:\n", 1)[1].split("memory:\n")[0]
        names = [line.rsplit(None, 2)[0].strip() for line in text.splitlines() if line.endswith(" ms")]
        declared = re.search(r"^  passes (.+)$", text, re.M)
        if declared:
            self.assertEqual(names, declared.group(1).split(", "))
        self.assertLessEqual(len(names), 5)

    def test_what_is_in_the_air_is_said(self):
        if not self.has_sky():
            self.skipTest("no air in this chapter")
        for medium in ("rayleigh", "mie", "ozone"):
            self.assertRegex(self.noon(), rf"(?m)^  {medium} +on +\S")

    def test_all_tables_on_request(self):
        if "tables" not in self.knobs():
            self.skipTest("no knob `tables` in this chapter")
        text = self.explain("--set", "tables=all", "--size", "32x18", "--frames", "4", *self.quick())
        runs = re.findall(r"ran in (\d+) of (\d+) frames", text)
        self.assertGreaterEqual(len(runs), 3)
        self.assertTrue(all(ran == frames for ran, frames in runs), text)

    def test_a_manual_exposure_leaves_no_meter(self):
        if "exposure.mode" not in self.knobs():
            self.skipTest("no light meter in this chapter")
        text = self.explain("--set", "exposure.mode=manual", "--size", "32x18", "--frames", "1", *self.quick())
        self.assertIn("exposure               off  post.exposure is manual", text)
        self.assertNotIn("histogram", re.sub(r"declared:\n.*\n", "", text))

    def test_the_book_has_these_knobs(self):
        if not (self.knobs() and (ROOT / "docs" / "generated" / f"knobs_{NUMBER}.json").exists()):
            self.skipTest("no table of knobs in the book")
        book = json.loads((ROOT / "docs" / "generated" / f"knobs_{NUMBER}.json").read_text())
        self.assertEqual({knob["name"]: knob for knob in book["knobs"]}, self.knobs(), f"write it anew: --dump knobs docs/generated/knobs_{NUMBER}.json")

    def test_bench_says_where(self):
        done = self.run_chapter(NUMBER, "--headless", "--size", "64x36", "--frames", "3", "--bench", "b.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        bench = json.loads((self.directory / "b.json").read_text())
        for key in ("device", "driver", "width", "height", "passes", "wall_ms", "warmup", "repeats", "date"):
            self.assertIn(key, bench)
        self.assertGreater(bench["wall_ms"]["median_ms"], 0)
        self.assertLessEqual(bench["wall_ms"]["min_ms"], bench["wall_ms"]["max_ms"])


class Picture(ChapterCase):
    def test_everything_small(self):
        """Every shipped scene and view and odd sizes are finite; a followed program draws what a fresh one does; each medium
        left out makes another picture with no other pass and not a byte more."""
        done = self.run_chapter(NUMBER, "--survey", *self.quick())
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        views = sum(file.read_text().count("[[view]]") for file in (ROOT / "chapters" / "scenes").glob("*.toml"))
        drawn = int(re.search(r"survey: (\d+) pictures, 0 wrong", done.stdout).group(1))
        self.assertEqual(drawn, views + 4 + (3 if self.has_sky() else 0))

    def test_a_survey_sees_a_fault(self):
        if self.has_sky():
            self.skipTest("shown by the chapters before the sky, which draw quickly")
        done = self.run_chapter(NUMBER, "--survey", "--inject", "nan")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("1 pixel is not finite", done.stdout)
        done = self.run_chapter(NUMBER, "--headless", "--size", "16x9", "--inject", "nan", "--output", "p.png")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)

    def test_a_picture_restores_itself(self):
        """Through decimal text and back: at most the last bit of a direction, so at most one level."""
        for arguments in (["--scene", "sunset", "--output", "a.png"], ["--scene", "a.png", "--output", "b.png"]):
            done = self.run_chapter(NUMBER, "--headless", "--size", "129x65", *arguments, *self.quick())
            self.assertEqual(done.returncode, 0, done.stderr)
        first, second = read_png(self.directory / "a.png"), read_png(self.directory / "b.png")
        self.assertEqual(first[:2], (129, 65))
        self.assertLessEqual(max(abs(a - b) for x, y in zip(first[3], second[3], strict=True) for a, b in zip(x, y, strict=True)), 1)


if __name__ == "__main__":
    NUMBER, kind = sys.argv[1], sys.argv[2].capitalize()
    unittest.main(argv=[sys.argv[0], kind, "-v"])
