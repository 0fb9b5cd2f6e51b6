"""What every chapter must do: its goldens, synchronization validation, counts and bytes, and the faults that must be seen.

Usage: chapter_test.py NN KIND with KIND golden, sync, cost or picture.
"""
import json
import re
import struct
import sys
import unittest

sys.path.insert(0, __file__.rsplit("/", 2)[0] + "/cli")
from welkin_case import BUILD, CHAPTERS, ROOT, WelkinCase, read_png  # noqa: E402

NUMBER = "05"
SKY_FROM = 4  # chapters whose picture depends on the air
GRAPH_FROM = 8  # chapters whose frame is a graph


class Golden(WelkinCase):
    def test_standard_views_are_the_goldens(self):
        done = self.run_chapter(NUMBER, "--golden", "check")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreaterEqual(done.stdout.count("golden "), 3 if int(NUMBER) >= 3 else 1)

    def test_a_nan_is_seen(self):
        done = self.run_chapter(NUMBER, "--golden", "check", "--inject", "nan")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        done = self.run_chapter(NUMBER, "--headless", "--size", "16x9", "--inject", "nan", "--output", "p.png")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)

    def test_a_missing_golden_is_a_failure(self):
        done = self.run_chapter(NUMBER, "--golden", "check", WELKIN_SOURCE=str(self.copy_without_goldens()))
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("missing", done.stdout)

    def copy_without_goldens(self):
        import shutil
        shutil.copytree(ROOT / "chapters", self.directory / "tree" / "chapters")
        return self.directory / "tree"

    def test_a_wrong_constant_is_seen(self):
        if int(NUMBER) < SKY_FROM:
            self.skipTest("no constant of the air in this chapter")
        done = self.run_chapter(NUMBER, "--golden", "check", "--inject", "wrong-constant")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)


class Sync(WelkinCase):
    def test_no_validation_message(self):
        done = self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--frames", "3", "--validation", "sync", "--output", "p.png")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertNotIn("validation:", done.stderr)

    def test_a_planted_missing_barrier_is_caught(self):
        done = self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--validation", "sync", "--inject", "missing-barrier", "--output", "p.png")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("READ_AFTER_WRITE", done.stderr)

    def test_the_picture_does_not_show_it(self):
        """Why the layer is needed: on a software driver the faulty picture is the same."""
        for fault, name in (([], "good.exr"), (["--inject", "missing-barrier"], "faulty.exr")):
            self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--output", name, *fault)
        self.assertEqual((self.directory / "good.exr").read_bytes(), (self.directory / "faulty.exr").read_bytes())

    def test_a_barrier_the_graph_forgets_is_caught(self):
        """As above, with the barriers a frame graph derives before reads; and the picture does not show it either."""
        if int(NUMBER) < GRAPH_FROM:
            self.skipTest("no frame graph in this chapter")
        fault = ("--inject", "graph-barrier")
        done = self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--validation", "sync", *fault, "--output", "p.png")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("READ_AFTER_WRITE", done.stderr)
        for name, arguments in (("good.exr", ()), ("faulty.exr", fault)):
            self.run_chapter(NUMBER, "--headless", "--size", "40x24", "--output", name, *arguments)
        self.assertEqual((self.directory / "good.exr").read_bytes(), (self.directory / "faulty.exr").read_bytes())

    def test_probe_is_clean(self):
        if int(NUMBER) < 5:
            self.skipTest("no probe in this chapter")
        (self.directory / "rays.csv").write_text("altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg\n0,10,20,30\n")
        done = self.run_chapter(NUMBER, "--probe", "rays.csv", "--probe-out", "out.csv", "--validation", "sync")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Cost(WelkinCase):
    def explain(self, *arguments):
        done = self.run_chapter(NUMBER, "--headless", "--size", "320x180", "--frames", "4", "--explain", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_no_allocation_after_the_first_frame(self):
        self.assertIn("allocations by frames after the first: 0\n", self.explain())

    def test_bytes(self):
        """One float picture and one 8-bit picture, and no more than 64 KiB beside them unless the chapter says why."""
        extra = {"04": 4 << 20, "07": 320 * 180 * 64 + (64 << 10), "08": (2 << 20) + (64 << 10), "09": 1 << 20, "10": 3 << 20, "11": 26 << 20}.get(NUMBER, 64 << 10)
        bytes_held = int(re.search(r"^  total +(\d+) bytes$", self.explain(), re.M).group(1))
        pictures = 320 * 180 * (16 + 4)
        self.assertGreaterEqual(bytes_held, pictures)
        self.assertLessEqual(bytes_held, pictures + extra)

    def test_all_tables_on_request(self):
        if int(NUMBER) < 10:
            self.skipTest("no knob `tables` in this chapter")
        text = self.explain("--set", "tables=all", "--set", "multiple_scattering.iterations=3", "--set", "multiple_scattering.directions=16")
        runs = re.findall(r"ran in (\d+) of (\d+) frames", text)
        self.assertGreaterEqual(len(runs), 5)
        self.assertTrue(all(ran == frames for ran, frames in runs), text)

    def test_a_manual_exposure_leaves_no_meter(self):
        if NUMBER != "06":
            self.skipTest("the meter is chapter 06's; its later users bring nothing of their own")
        text = self.explain("--set", "exposure.mode=manual")
        self.assertIn("light meter            off", text)
        self.assertNotIn("histogram", text)

    def test_passes(self):
        text = self.explain().split("passes:\n")[1].split("memory:\n")[0]
        names = [line.rsplit(None, 2)[0].strip() for line in text.splitlines() if line.endswith(" ms")]
        wanted = {"01": ["first light"], "02": ["first light"], "05": ["march"], "06": ["march", "histogram", "exposure"], "07": ["trace", "resolve", "histogram", "exposure"], "08": ["march", "histogram", "exposure"], "09": ["march", "histogram", "exposure"], "10": ["sky", "histogram", "exposure"], "11": ["sky", "compose", "histogram", "exposure"]}
        if NUMBER in wanted:
            self.assertEqual(names, wanted[NUMBER] + ["display"])
        self.assertLessEqual(len(names), 5)

    def test_what_the_scene_lacks_is_not_there(self):
        """Each medium left out: said to be off and why, another picture, and not a byte or a pass more."""
        if int(NUMBER) < SKY_FROM:
            self.skipTest("no air in this chapter")
        whole = (ROOT / "chapters" / "scenes" / "noon.toml").read_text()
        held = re.compile(r"^  total +(\d+) bytes$", re.M)
        passes = re.compile(r"passes:\n(.*?)memory:", re.S)
        reference = self.explain("--scene", "noon")
        self.run_chapter(NUMBER, "--headless", "--size", "32x18", "--scene", "noon", "--output", "whole.exr")
        for medium in ("rayleigh", "mie", "ozone"):
            without = re.sub(r'\[\[medium\]\]\nkind = "%s".*?\n\n' % medium, "", whole, flags=re.S)
            self.assertNotIn(f'kind = "{medium}"', without)
            (self.directory / "without.toml").write_text(without)
            text = self.explain("--scene", "without.toml")
            self.assertRegex(text, rf"(?m)^  {medium} +off +\S")
            self.assertRegex(reference, rf"(?m)^  {medium} +on +\S")
            self.assertLessEqual(int(held.search(text).group(1)), int(held.search(reference).group(1)))
            names = [[line.split()[0] for line in passes.search(t).group(1).splitlines()] for t in (text, reference)]
            self.assertEqual(names[0], names[1])
            self.run_chapter(NUMBER, "--headless", "--size", "32x18", "--scene", "without.toml", "--output", "without.exr")
            self.assertNotEqual((self.directory / "without.exr").read_bytes(), (self.directory / "whole.exr").read_bytes())

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
        for size in ("1x1", "7x3", "1x33", "129x65"):
            done = self.run_chapter(NUMBER, "--headless", "--size", size, "--output", "p.png")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(read_png(self.directory / "p.png")[:2], tuple(map(int, size.split("x"))))

    def test_every_scene_and_view_is_finite(self):
        import tomllib
        # Whether every view is finite does not depend on how finely chapter 09's table was gathered.
        quick = ["--set", "multiple_scattering.iterations=3", "--set", "multiple_scattering.directions=16"] if int(NUMBER) >= 9 else []
        for scene in sorted((ROOT / "chapters" / "scenes").glob("*.toml")):
            for view in tomllib.loads(scene.read_text())["view"]:
                done = self.run_chapter(NUMBER, "--headless", "--size", "32x18", "--scene", scene.stem, "--view", view["name"], "--output", "p.exr", *quick)
                self.assertEqual(done.returncode, 0, f"{scene.stem}/{view['name']}: {done.stderr}")

    def test_same_bits_again(self):
        for name in ("a.exr", "b.exr"):
            self.run_chapter(NUMBER, "--headless", "--size", "64x36", "--output", name)
        self.assertEqual((self.directory / "a.exr").read_bytes(), (self.directory / "b.exr").read_bytes())

    def test_a_picture_restores_itself(self):
        self.run_chapter(NUMBER, "--headless", "--size", "64x36", "--scene", "sunset", "--output", "a.png")
        self.run_chapter(NUMBER, "--headless", "--size", "64x36", "--scene", "a.png", "--output", "b.png")
        first, second = read_png(self.directory / "a.png"), read_png(self.directory / "b.png")
        # Through decimal text and back: at most the last bit of a direction, so at most one level.
        self.assertLessEqual(max(abs(a - b) for x, y in zip(first[3], second[3]) for a, b in zip(x, y)), 1)


if __name__ == "__main__":
    NUMBER, kind = sys.argv[1], sys.argv[2].capitalize()
    unittest.main(argv=[sys.argv[0], kind, "-v"])
