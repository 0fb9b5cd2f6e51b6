"""A picture restores what it shows: time, place, exposure, map; and a path moves the camera."""
import shutil
import unittest

from welkin_case import ROOT, WelkinCase, carried, read_png, rgb

HEAD = "version = 1\n[[medium]]\nkind = \"rayleigh\"\nscattering_per_km = [5.802e-3, 13.558e-3, 33.1e-3]\n"
QUICK = ("--headless", "--set", "view.steps=8")
SMALL = (*QUICK, "--size", "48x27")


class SceneCase(WelkinCase):
    def draw(self, *arguments, output, chapter="05", code=0):
        done = self.run_chapter(chapter, *SMALL, "--output", output, *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        return rgb(read_png(self.directory / output))

    def scene(self, text, name="scene.toml"):
        path = self.directory / name
        path.write_text(HEAD + text)
        return path


class Restoring(SceneCase):
    def test_the_time_is_restored_and_goes_on_from_there(self):
        """Through a picture the sun stands where --time puts it directly, also when time passes again."""
        now = self.draw("--scene", "today", output="now.png")
        later = self.draw("--scene", "today", "--time", "7200", output="later.png")
        self.assertNotEqual(now, later)
        self.assertIn("\ntime_s = 7200\n", carried(self.directory / "later.png"))
        self.assertEqual(self.draw("--scene", "later.png", output="again.png"), later)
        self.assertEqual(self.draw("--scene", "now.png", "--time", "7200", output="from_now.png"), later)
        self.assertEqual(self.draw("--scene", "later.png", "--time", "0", output="back.png"), now)

    def test_time_without_a_latitude_is_asked_for(self):
        path = self.scene("[sun]\nzenith_deg = 60\n[[view]]\nname = \"v\"\n")
        done = self.run_chapter("05", *SMALL, "--scene", path, "--time", "60", "--output", "a.png")
        self.assert_refused(done, "--time 60", "no latitude", "latitude_deg in [sun]", files=["scene.toml"])
        self.draw("--scene", path, "--time", "0", output="a.png")
        path = self.scene("[sun]\nzenith_deg = 60\nlatitude_deg = 10\n[[view]]\nname = \"v\"\n")
        self.assertNotEqual(self.draw("--scene", path, "--time", "60000", output="b.png"), self.draw("--scene", path, output="a.png"))

    def test_place_and_straight_down_are_restored(self):
        path = self.scene("[sun]\nzenith_deg = 80\nazimuth_deg = 90\n[[view]]\nname = \"v\"\naltitude_km = 2000\n"
                          "east_km = 3000\nnorth_km = -8000\nelevation_deg = -90\nazimuth_deg = 20\nfov_deg = 100\n")
        away = self.draw("--scene", path, output="away.png")
        self.assertEqual(self.draw("--scene", "away.png", output="again.png"), away)
        at_home = path.read_text().replace("east_km = 3000\nnorth_km = -8000\n", "")
        path.write_text(at_home)
        self.assertNotEqual(self.draw("--scene", path, output="home.png"), away, "the sun stands lower there")

    def test_the_disc_from_far_away_is_in_the_middle(self):
        """Elevation -90 is straight down, to the pixel: the planet's picture is symmetric."""
        path = self.scene("[sun]\nzenith_deg = 0\n[[view]]\nname = \"far\"\naltitude_km = 1000000\nazimuth_deg = 90\nelevation_deg = -90\nfov_deg = 1\n")
        done = self.run_chapter("05", *QUICK, "--size", "65x65", "--scene", path, "--output", "far.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = rgb(read_png(self.directory / "far.png"))
        lit = [(x, y) for y, row in enumerate(rows) for x in range(65) if max(row[3 * x:3 * x + 3]) > 8]
        self.assertGreater(len(lit), 500)
        self.assertAlmostEqual(sum(x for x, _ in lit) / len(lit), 32, delta=0.1)
        self.assertAlmostEqual(sum(y for _, y in lit) / len(lit), 32, delta=0.1)

    def test_a_picture_of_64_views_has_one_more_and_is_read(self):
        views = "".join(f"[[view]]\nname = \"v{i}\"\n" for i in range(64))
        path = self.scene(views)
        first = self.draw("--scene", path, output="one.png")
        self.assertEqual(self.draw("--scene", "one.png", output="two.png"), first)
        self.assertEqual(carried(self.directory / "two.png").count("[[view]]"), 65)
        done = self.run_chapter("05", *SMALL, "--scene", self.scene(views + "[[view]]\nname = \"w\"\n"), "--output", "three.png")
        self.assert_refused(done, "too many views", "up to 64", files=["one.png", "two.png", "scene.toml"])

    def test_exposure_has_one_owner(self):
        """The knobs of the exposure are the scene's fields: set, they are saved as such."""
        self.draw("--scene", "noon", "--set", "exposure.mode=manual", "--set", "exposure.ev=2", "--set", "exposure.compensation=-1", chapter="06", output="a.png")
        text = carried(self.directory / "a.png")
        for line in ("exposure = \"manual\"", "exposure_ev = 2", "compensation_ev = -1"):
            self.assertIn(f"\n{line}\n", text)
        self.assertNotIn("exposure.", text)
        self.assertEqual(self.draw("--scene", "a.png", chapter="06", output="b.png"), rgb(read_png(self.directory / "a.png")))
        done = self.run_chapter("05", *SMALL, "--set", "exposure.mode=auto")
        self.assert_refused(done, "unknown knob 'exposure.mode'", files=["a.png", "b.png"])

    def test_a_height_map_moved_with_its_picture_is_found(self):
        """No path of the author's machine is in a picture; odd directory names are none of its business."""
        maps, pictures = self.directory / "the\nmaps", self.directory / "pictures"
        maps.mkdir(), pictures.mkdir()
        shutil.copy(ROOT / "tests" / "data" / "small_map.png", maps / "small.png")
        (maps / "s.toml").write_text(HEAD + "[sun]\nzenith_deg = 60\n[[view]]\nname = \"n\"\naltitude_km = 2\nelevation_deg = -5\n[terrain]\nheight_map = \"small.png\"\n")
        first = self.draw("--scene", maps / "s.toml", chapter="11", output="pictures/a.png")
        text = carried(pictures / "a.png")
        self.assertIn("\nheight_map = \"small.png\"\n", text)
        self.assertNotIn(str(self.directory), text)
        moved = self.directory / "moved"
        moved.mkdir()
        shutil.move(pictures / "a.png", moved / "a.png")
        shutil.move(maps / "small.png", moved / "small.png")
        self.assertEqual(self.draw("--scene", moved / "a.png", chapter="11", output="b.png"), first)
        (self.directory / "maps").mkdir()
        shutil.move(moved / "small.png", self.directory / "maps" / "small.png")
        shutil.copy(ROOT / "tests" / "data" / "small_map.png", self.directory / "small.png")
        self.draw("--scene", "b.png", chapter="11", output="maps/c.png")
        self.assertIn("\nheight_map = \"../small.png\"\n", carried(self.directory / "maps" / "c.png"))


class Paths(SceneCase):
    PATH = ("[sun]\nzenith_deg = 60\nlatitude_deg = 40\n[[view]]\nname = \"a\"\n[[view]]\nname = \"b\"\naltitude_km = 30\nelevation_deg = -10\nazimuth_deg = 200\n"
            "[[path]]\nname = \"rise\"\nviews = [\"a\", \"b\"]\ntime_s = [1, 3]\nmoment_s = [0, 3600]\n")

    def test_frames_are_numbered_and_each_is_restored(self):
        path = self.scene(self.PATH)
        done = self.run_chapter("05", *SMALL, "--scene", path, "--path", "rise", "--frames", "3", "--output", "f.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.files(), ["f_0000.png", "f_0001.png", "f_0002.png", "scene.toml"])
        frames = [rgb(read_png(self.directory / f"f_000{i}.png")) for i in range(3)]
        self.assertEqual(frames[0], self.draw("--scene", path, "--view", "a", output="a.png"))
        self.assertEqual(frames[2], self.draw("--scene", path, "--view", "b", "--time", "3600", output="b.png"))
        self.assertEqual(frames[1], self.draw("--scene", "f_0001.png", output="c.png"))
        text = carried(self.directory / "f_0001.png")
        self.assertIn("\ntime_s = 1800\n", text)
        self.assertRegex(text, r"name = \"restored\"\n(.*\n)*?altitude_km = 0\.2")  # in the logarithm between 0.5 m and 30 km

    def test_the_path_of_another_file(self):
        other = self.scene(self.PATH, "path.toml")
        done = self.run_chapter("05", *SMALL, "--scene", "noon", "--path", other, "--frames", "2", "--output", "f.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(rgb(read_png(self.directory / "f_0001.png")), self.draw("--scene", "f_0001.png", output="g.png"))

    def test_refused(self):
        path = self.scene(self.PATH)
        for arguments, words in ((["--path", "fall"], ("path 'fall'", "has rise")),
                                 (["--path", "rise", "--view", "a"], ("--path rise", "--view a")),
                                 (["--path", "none.toml"], ("none.toml",))):
            with self.subTest(arguments):
                done = self.run_chapter("05", *SMALL, "--scene", path, "--output", "x.png", *arguments)
                self.assert_refused(done, *words, files=["scene.toml"])
        other = self.scene(self.PATH.replace("altitude_km = 30", "altitude_km = 31"), "other.toml")
        done = self.run_chapter("05", *SMALL, "--scene", path, "--path", other, "--output", "x.png")
        self.assert_refused(done, "--path", "another 'b'", files=["other.toml", "scene.toml"])

    def test_a_bench_times_the_frames_of_a_path(self):
        path = self.scene(self.PATH)
        done = self.run_chapter("05", "--headless", "--size", "16x16", "--scene", path, "--path", "rise", "--frames", "5", "--bench", "b.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.directory / "b.json").read_text()
        self.assertRegex(text, r'"view": "rise"')


if __name__ == "__main__":
    unittest.main()
