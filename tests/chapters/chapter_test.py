"""What every chapter must do: its goldens, synchronization validation, counts and bytes, and the faults that must be seen.

Usage: chapter_test.py NN KIND with KIND golden, sync, cost or picture.
"""
import json
import re
import shutil
import sys
import tomllib
import unittest

sys.path.insert(0, __file__.rsplit("/", 2)[0] + "/cli")
from welkin_case import BUILD, CHAPTERS, ROOT, WelkinCase, read_png  # noqa: E402

NUMBER = "05"
SKY_FROM = 4  # chapters whose picture depends on the air
GRAPH_FROM = 8  # chapters whose frame is a graph


def goldens():
    """The chapter's golden pictures, NN_scene_view.exr."""
    return sorted((ROOT / "tests" / "data" / "golden").glob(f"{NUMBER}_*.exr"))


# A start compiles a chapter's shaders and fills its tables: seconds, from chapter 09 on. So a run serves as many checks as
# it can, and a later chapter draws only what is not an earlier one's picture already.


class Golden(WelkinCase):
    def test_standard_views_are_the_goldens(self):
        done = self.run_chapter(NUMBER, "--golden", "check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreaterEqual(done.stdout.count("golden "), 3 if int(NUMBER) >= 3 else 1)

    def check_one(self, *fault):
        """--golden check in a copy of the tree with one golden: that view is drawn, the others are said to be missing."""
        kept = self.directory / "tree" / "tests" / "data" / "golden"
        if not kept.exists():
            shutil.copytree(ROOT / "chapters", self.directory / "tree" / "chapters")
            kept.mkdir(parents=True)
            for file in goldens()[0], goldens()[0].with_suffix(".driver"):
                shutil.copy(file, kept)
        done = self.run_chapter(NUMBER, "--golden", "check", *fault, WELKIN_SOURCE=str(self.directory / "tree"))
        self.assertEqual(done.stdout.count(": missing"), len(goldens()) - 1, done.stdout)
        return done, next(line for line in done.stdout.splitlines() if goldens()[0].stem in line)

    def test_faults_are_seen(self):
        """A NaN, a wrong constant, a missing golden. The exit code of a fault alone: chapters 01 and 02, of one view each."""
        done, line = self.check_one("--inject", "nan")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("DIFFERS", line)
        self.assertIn("NaN", line)
        done = self.run_chapter(NUMBER, "--headless", "--size", "16x9", "--inject", "nan", "--output", "p.png")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        if int(NUMBER) >= SKY_FROM:
            done, line = self.check_one("--inject", "wrong-constant")
            self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
            self.assertIn("DIFFERS", line)
            self.assertNotIn("NaN", line)


class Sync(WelkinCase):
    def draw(self, *arguments):
        """Exit code, messages and picture of three small frames under synchronization validation."""
        done = self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--frames", "3", "--validation", "sync", "--output", "p.exr", *arguments)
        return done.returncode, done.stderr, (self.directory / "p.exr").read_bytes()

    def test_no_message_and_planted_faults_are_caught(self):
        """And why the layer is needed: on a software driver the faulty pictures are the same, bit for bit."""
        code, messages, good = self.draw()
        self.assertEqual(code, 0, messages)
        self.assertNotIn("validation:", messages)
        for fault in ("missing-barrier", "graph-barrier")[:1 + (int(NUMBER) >= GRAPH_FROM)]:
            code, messages, faulty = self.draw("--inject", fault)
            self.assertEqual(code, 3, messages)
            self.assertIn("READ_AFTER_WRITE", messages)
            self.assertEqual(faulty, good, fault)

    def test_probe_is_clean(self):
        if int(NUMBER) < 5:
            self.skipTest("no probe in this chapter")
        (self.directory / "rays.csv").write_text("altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg\n0,10,20,30\n")
        done = self.run_chapter(NUMBER, "--probe", "rays.csv", "--probe-out", "out.csv", "--validation", "sync")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Cost(WelkinCase):
    plain = None  # explain() without arguments, for all tests

    def explain(self, *arguments):
        """What --explain says of four frames, and the last frame."""
        done = self.run_chapter(NUMBER, "--headless", "--size", "320x180", "--frames", "4", "--explain", "--output", "p.exr", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, (self.directory / "p.exr").read_bytes()

    def noon(self):
        if Cost.plain is None:
            Cost.plain = self.explain("--scene", "noon")
        return Cost.plain

    def test_no_allocation_after_the_first_frame(self):
        self.assertIn("allocations by frames after the first: 0\n", self.noon()[0])

    def test_bytes(self):
        """One float picture and one 8-bit picture, and no more beside them than the chapter declares."""
        extra = int(re.search(r"^  bytes (\d+)$", self.noon()[0], re.M).group(1))
        bytes_held = int(re.search(r"^  total +(\d+) bytes$", self.noon()[0], re.M).group(1))
        pictures = 320 * 180 * (16 + 4)
        self.assertGreaterEqual(bytes_held, pictures)
        self.assertLessEqual(bytes_held, pictures + extra)

    def test_all_tables_on_request(self):
        if int(NUMBER) < 9:
            self.skipTest("no knob `tables` in this chapter")
        text = self.explain("--set", "tables=all", "--set", "multiple_scattering.iterations=3", "--set", "multiple_scattering.directions=16")[0]
        runs = re.findall(r"ran in (\d+) of (\d+) frames", text)
        self.assertGreaterEqual(len(runs), 3 if NUMBER == "09" else 5)
        self.assertTrue(all(ran == frames for ran, frames in runs), text)

    def test_a_manual_exposure_leaves_no_meter(self):
        if NUMBER != "06":
            self.skipTest("the meter is chapter 06's; its later users bring nothing of their own")
        text = self.explain("--set", "exposure.mode=manual")[0]
        self.assertIn("exposure               off  post.exposure is manual", text)
        self.assertNotIn("histogram", re.sub(r"declared:\n.*\n", "", text))

    def test_passes(self):
        text = self.noon()[0].split("passes:\n", 1)[1].split("memory:\n")[0]
        names = [line.rsplit(None, 2)[0].strip() for line in text.splitlines() if line.endswith(" ms")]
        declared = re.search(r"^  passes (.+)$", text, re.M)
        if declared:
            self.assertEqual(names, declared.group(1).split(", "))
        self.assertLessEqual(len(names), 5)

    def test_what_the_scene_lacks_is_not_there(self):
        """Each medium left out: said to be off and why, another picture, and not a byte or a pass more."""
        if int(NUMBER) < SKY_FROM:
            self.skipTest("no air in this chapter")
        whole = (ROOT / "chapters" / "scenes" / "noon.toml").read_text()
        held = re.compile(r"^  total +(\d+) bytes$", re.M)
        passes = re.compile(r"passes:\n(.*?)memory:", re.S)
        reference, whole_picture = self.noon()
        for medium in ("rayleigh", "mie", "ozone"):
            without = re.sub(r'\[\[medium\]\]\nkind = "%s".*?\n\n' % medium, "", whole, flags=re.S)
            self.assertNotIn(f'kind = "{medium}"', without)
            (self.directory / "without.toml").write_text(without)
            text, picture = self.explain("--scene", "without.toml")
            self.assertRegex(text, rf"(?m)^  {medium} +off +\S")
            self.assertRegex(reference, rf"(?m)^  {medium} +on +\S")
            self.assertLessEqual(int(held.search(text).group(1)), int(held.search(reference).group(1)))
            names = [[line.split()[0] for line in passes.search(t).group(1).splitlines()] for t in (text, reference)]
            self.assertEqual(names[0], names[1])
            self.assertNotEqual(picture, whole_picture)

    def test_bench_says_where(self):
        done = self.run_chapter(NUMBER, "--headless", "--size", "64x36", "--frames", "3", "--bench", "b.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        bench = json.loads((self.directory / "b.json").read_text())
        for key in ("device", "driver", "width", "height", "passes", "wall_ms", "warmup", "repeats", "date"):
            self.assertIn(key, bench)
        self.assertGreater(bench["wall_ms"]["median_ms"], 0)
        self.assertLessEqual(bench["wall_ms"]["min_ms"], bench["wall_ms"]["max_ms"])


class Picture(WelkinCase):
    def test_odd_sizes(self):
        for size in ("1x1", "1x33"):  # and 129x65 below
            done = self.run_chapter(NUMBER, "--headless", "--size", size, "--output", "p.png")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(read_png(self.directory / "p.png")[:2], tuple(map(int, size.split("x"))))

    def test_every_scene_and_view_is_finite(self):
        """All but the standard views, which are finite if they are the goldens, and what an earlier chapter draws: above 20 km
        chapter 10 marches as 09 does, without terrain 11's picture is 10's bit for bit (gpu_tests.10_sky_hard,
        gpu_tests.11_picture_hard; the former also asks for numbers that are none, from everywhere)."""
        # Whether a view is finite does not depend on how finely chapter 09's table was gathered.
        quick = ["--set", "multiple_scattering.iterations=3", "--set", "multiple_scattering.directions=16"] if int(NUMBER) >= 9 else []
        drawn = {golden.stem[3:] for golden in goldens()}
        for file in sorted((ROOT / "chapters" / "scenes").glob("*.toml")):
            scene = tomllib.loads(file.read_text())
            for view in scene["view"]:
                if (f"{file.stem}_{view['name']}" in drawn or NUMBER == "10" and view.get("altitude_km", 0.0) > 20.0
                        or NUMBER == "11" and "terrain" not in scene):
                    continue
                done = self.run_chapter(NUMBER, "--headless", "--size", "32x18", "--scene", file.stem, "--view", view["name"], "--output", "p.exr", *quick)
                self.assertEqual(done.returncode, 0, f"{file.stem}/{view['name']}: {done.stderr}")

    def test_same_bits_again_and_from_the_picture(self):
        for name in ("a", "b"):
            done = self.run_chapter(NUMBER, "--headless", "--size", "129x65", "--scene", "sunset", "--output", f"{name}.png", "--dump", "picture", f"{name}.exr")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.directory / "a.exr").read_bytes(), (self.directory / "b.exr").read_bytes())
        # A picture restores itself, through decimal text and back: at most the last bit of a direction, so at most one level.
        self.run_chapter(NUMBER, "--headless", "--size", "129x65", "--scene", "a.png", "--output", "c.png")
        first, second = read_png(self.directory / "a.png"), read_png(self.directory / "c.png")
        self.assertEqual(first[:2], (129, 65))
        self.assertLessEqual(max(abs(a - b) for x, y in zip(first[3], second[3], strict=True) for a, b in zip(x, y, strict=True)), 1)


if __name__ == "__main__":
    NUMBER, kind = sys.argv[1], sys.argv[2].capitalize()
    unittest.main(argv=[sys.argv[0], kind, "-v"])
