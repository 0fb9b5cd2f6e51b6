"""A real window under Xvfb with real keys, mouse and resizes: what it shows is what a headless run writes."""
import os
import re
import resource
import shutil
import signal
import subprocess
import time
import unittest

from welkin_case import BUILD, ROOT, WelkinCase, carried, read_png, rgb

TOOLS = ("Xvfb", "xdotool", "import", "convert")


@unittest.skipIf(any(shutil.which(tool) is None for tool in TOOLS), "needs " + ", ".join(TOOLS))
class Window(WelkinCase):
    def setUp(self):
        super().setUp()
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1000x700x24"], pass_fds=[write],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = ":" + pipe.readline().strip()
        self.addCleanup(self.server.wait)
        self.addCleanup(self.server.kill)
        self.program = None
        self.limits = {}  # more keywords for the program's start

    def open(self, chapter="02_window", *arguments, **environment):
        self.errors = open(self.directory / "stderr.txt", "w+")
        self.addCleanup(self.errors.close)
        self.program = subprocess.Popen([BUILD / "bin" / chapter, *arguments], cwd=self.directory, text=True,
                                        env={**os.environ, "DISPLAY": self.display, **environment},
                                        stdout=subprocess.PIPE, stderr=self.errors, **self.limits)
        self.addCleanup(self.program.stdout.close)
        self.addCleanup(self.program.wait)
        self.addCleanup(self.program.kill)
        self.assertIn("window on", self.program.stdout.readline(), self.error_text())
        self.window = self.xdotool("search", "--sync", "--onlyvisible", "--name", "Welkin").split()[0]
        self.xdotool("windowfocus", self.window)
        time.sleep(0.5)

    def error_text(self):
        self.errors.seek(0)
        return self.errors.read()

    def xdotool(self, *arguments):
        return subprocess.run(["xdotool", *arguments], env={**os.environ, "DISPLAY": self.display}, text=True,
                              capture_output=True, timeout=30, check=True).stdout

    def key(self, name):
        self.xdotool("key", "--window", self.window, name)
        time.sleep(0.5)

    def screen(self, name):
        """The window as the display shows it, taken by another program."""
        path = self.directory / name
        subprocess.run(["import", "-window", self.window, "-depth", "8", "-type", "TrueColor", "-define", "png:color-type=2", path],
                       env={**os.environ, "DISPLAY": self.display}, check=True, timeout=30)
        return read_png(path)

    def saved(self):
        """Presses the screenshot key and returns the file the program says it wrote."""
        self.key("p")
        line = self.program.stdout.readline()
        self.assertIn("saved out/", line)
        return self.directory / line.split()[1]

    def quit(self, code=0):
        # Only the key's press: the window may be gone before its release.
        self.xdotool("keydown", "--window", self.window, "Escape")
        self.assertEqual(self.program.wait(timeout=30), code, self.error_text())

    def headless(self, *arguments):
        self.run_chapter("02", "--headless", "--output", "headless.png", *arguments)
        return rgb(read_png(self.directory / "headless.png"))

    def test_window_shows_the_headless_bits(self):
        self.open("02_window", "--size", "401x299", "--validation", "sync")
        self.assertNotEqual(rgb(self.screen("panel.png")), self.headless("--size", "401x299"), "the panel is drawn")
        self.key("h")
        self.assertEqual(rgb(self.screen("screen.png")), self.headless("--size", "401x299"))
        self.assertEqual(rgb(read_png(self.saved())), self.headless("--size", "401x299"))
        self.quit()

    def test_resize_follows(self):
        self.open("02_window", "--size", "320x200", "--validation", "sync")
        for width, height in ((500, 333), (64, 48), (640, 360)):
            self.xdotool("windowsize", "--sync", self.window, str(width), str(height))
            time.sleep(0.7)
        self.key("h")
        self.assertEqual(rgb(self.screen("screen.png")), self.headless("--size", "640x360"))
        self.assertEqual(read_png(self.saved())[:2], (640, 360))
        self.quit()

    def test_hidden_and_shown_again(self):
        self.open("02_window", "--size", "320x200", "--validation", "sync")
        self.xdotool("windowunmap", "--sync", self.window)
        time.sleep(0.5)
        self.assertIsNone(self.program.poll(), self.error_text())
        self.xdotool("windowmap", "--sync", self.window)
        time.sleep(0.5)
        self.xdotool("windowfocus", self.window)
        self.key("h")
        self.assertEqual(rgb(self.screen("screen.png")), self.headless("--size", "320x200"))
        self.quit()

    def test_flying_moves_the_camera_and_a_picture_restores_it(self):
        self.open("05_single_scattering", "--size", "160x90", "--scene", "noon", "--set", "view.steps=8", "--validation", "sync")
        before = self.saved()
        self.key("f")
        self.xdotool("keydown", "--window", self.window, "w")
        time.sleep(1.0)
        self.xdotool("keyup", "--window", self.window, "w")
        self.xdotool("mousemove_relative", "--", "60", "-25")
        time.sleep(0.7)
        after = self.saved()
        self.quit()
        self.assertNotEqual(rgb(read_png(before)), rgb(read_png(after)), "the camera turned")
        self.run_chapter("05", "--headless", "--size", "160x90", "--scene", after, "--output", "again.png")
        again = rgb(read_png(self.directory / "again.png"))
        wanted = rgb(read_png(after))
        # The restored camera went through decimal text: the same to one level of 255.
        worst = max(abs(a - b) for x, y in zip(again, wanted) for a, b in zip(x, y))
        self.assertLessEqual(worst, 1)

    def assert_restored(self, saved, *arguments):
        """Drawn headless from the picture that was saved, it is the same to one level: its numbers went through text."""
        wanted = read_png(saved)
        self.run_chapter("05", "--headless", "--size", f"{wanted[0]}x{wanted[1]}", "--scene", saved, "--output", "again.png", *arguments)
        pairs = zip(rgb(read_png(self.directory / "again.png")), rgb(wanted))
        self.assertLessEqual(max(abs(a - b) for x, y in pairs for a, b in zip(x, y)), 1)

    def test_flying_far_is_restored_with_the_sun_there(self):
        scene = self.directory / "high.toml"
        text = (ROOT / "chapters" / "scenes" / "orbit.toml").read_text()
        scene.write_text(text.replace("zenith_deg = 100.0", "zenith_deg = 70.0"))
        self.open("05_single_scattering", "--size", "160x90", "--scene", scene, "--view", "geostationary", "--set", "view.steps=8")
        self.key("f")
        self.xdotool("keydown", "--window", self.window, "d")
        time.sleep(2.0)
        self.xdotool("keyup", "--window", self.window, "d")
        time.sleep(0.5)
        saved = self.saved()
        self.quit()
        place = {key: float(value) for key, value in re.findall(r"^(east_km|north_km) = (\S+)$", carried(saved).split("[[view]]")[1], re.M)}
        self.assertGreater(abs(place["east_km"]) + abs(place["north_km"]), 500.0, "it flew")
        self.assert_restored(saved)

    def test_the_slider_of_the_time_is_saved(self):
        """The moment that is shown is the one that is restored: not that of --time, nor that of the scene."""
        self.open("05_single_scattering", "--size", "480x640", "--scene", "sunset", "--set", "view.steps=4", "--time", "600")
        moved = None
        for attempt in range(12):  # held until a picture shows it: how long a frame takes is not known
            if attempt % 4 == 0:
                self.xdotool("mousemove", "--window", self.window, "140", "136", "sleep", "1", "mousedown", "1")
            saved = self.saved()
            moved = re.search(r"^time_s = (-\S+)$", carried(saved), re.M)
            if moved:
                break
            if attempt % 4 == 3:
                self.xdotool("mouseup", "1", "sleep", "1")
        self.quit()
        self.assertTrue(moved, "the slider of the time was pressed")
        self.assertLess(float(moved[1]), -3600.0)
        self.assert_restored(saved)

    def test_a_path_is_played_until_the_camera_is_taken(self):
        scene = self.directory / "path.toml"
        path = "[[path]]\nname = \"rise\"\nviews = [\"horizon\", \"airliner\"]\ntime_s = [0, 60]\nmoment_s = [0, 7200]\n"
        scene.write_text((ROOT / "chapters" / "scenes" / "noon.toml").read_text() + path)
        self.open("05_single_scattering", "--size", "160x90", "--scene", scene, "--path", "rise", "--set", "view.steps=8")
        first, second = self.saved(), self.saved()
        self.key("f")
        third, fourth = self.saved(), self.saved()
        self.quit()
        times = [float(re.search(r"^time_s = (\S+)$", carried(saved), re.M)[1]) for saved in (first, second, third, fourth)]
        self.assertLess(times[0], times[1])
        self.assertLessEqual(times[1], times[2])
        self.assertEqual(times[2], times[3])
        self.assert_restored(second)

    def test_a_broken_shader_leaves_the_old_one_running(self):
        source = self.directory / "source"
        shutil.copytree(ROOT / "shaders", source / "shaders")
        shutil.copytree(ROOT / "chapters" / "scenes", source / "chapters" / "scenes")
        compiled = self.directory / "compiled"
        shutil.copytree(BUILD / "shaders", compiled)
        self.open("02_window", "--size", "320x200", WELKIN_SOURCE=str(source), WELKIN_SHADERS=str(compiled))
        shader = source / "shaders" / "01_first_light" / "first_light.comp"
        good = shader.read_text()
        shader.write_text(good.replace("void main()", "void main("))
        self.key("h")
        wanted = rgb(self.screen("one.png"))
        self.key("r")
        time.sleep(4)
        self.assertEqual(rgb(self.screen("two.png")), wanted, "the old pipeline stays")
        shader.write_text(good.replace("vec3(level)", "vec3(255 - level)"))
        self.key("r")
        time.sleep(4)
        inverted = rgb(self.screen("three.png"))
        self.assertEqual(inverted, [bytes(255 - value for value in row) for row in wanted], "the new one is in use")
        self.quit()

    def in_time(self, happened):
        """Whether something happens within the time that a busy machine may take for it."""
        return any(happened() or time.sleep(0.5) for _ in range(60))

    def refused(self, name, *words):
        """Presses a key that cannot do its work: a line on standard error and in the panel, and the view as it was."""
        before, already = rgb(self.screen("before.png")), len(self.error_text().splitlines())
        self.key(name)
        self.in_time(lambda: len(self.error_text().splitlines()) > already or self.program.poll() is not None)
        time.sleep(1.0)
        lines = self.error_text().splitlines()[already:]
        self.assertIsNone(self.program.poll(), self.error_text())
        self.assertEqual(len(lines), 1, lines)
        for word in words:
            self.assertIn(word, lines[0])
        self.assertTrue(rgb(self.screen("told.png")) != before, "the panel says it")
        self.assert_view_stays()

    def assert_view_stays(self):
        self.key("h")
        self.assertTrue(self.in_time(lambda: rgb(self.screen("hidden.png")) == self.view), "the view stays")
        self.key("h")

    def open_and_look(self, *arguments, **environment):
        self.open(*arguments, **environment)
        self.key("h")
        shots = [rgb(self.screen("view.png"))]  # until the panel is gone and the light meter has settled

        def settled():
            shots.append(rgb(self.screen("view.png")))
            return shots[-1] == shots[-2]
        time.sleep(0.5)
        self.assertTrue(self.in_time(settled), "the view comes to rest")
        self.view = shots[-1]
        self.key("h")

    def test_a_picture_that_cannot_be_written_is_told(self):
        self.open_and_look("02_window", "--size", "320x200", "--validation", "sync")
        place = self.directory / "out"
        place.write_text("a file where the directory should be")
        self.refused("p", "cannot save a picture", "'out'")
        place.unlink()
        place.symlink_to("/proc")  # where not even root may write
        self.refused("p", "cannot write 'out/02_window_001.png'")
        place.unlink()
        self.assertTrue(self.saved().exists())
        self.quit()

    def test_a_full_disk_is_told(self):
        def full():  # as far as a process can make it so for itself: no file grows beyond 300 bytes
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (300, resource.RLIM_INFINITY))
        self.limits = {"preexec_fn": full, "restore_signals": False}
        self.open_and_look("02_window", "--size", "320x200", MESA_SHADER_CACHE_DISABLE="true")
        self.refused("p", "cannot write 'out/02_window_001.png'", "File too large")
        self.assertEqual(list((self.directory / "out").iterdir()), [])
        self.quit()

    def test_shaders_and_truths_that_cannot_be_made_are_told(self):
        compiled = self.directory / "compiled"
        shutil.copytree(BUILD / "shaders", compiled)
        self.open_and_look("09_multiple_scattering_lut", "--size", "160x90", "--scene", "noon", WELKIN_SHADERS=str(compiled))
        shutil.rmtree(compiled / "07_ground_truth")
        self.refused("t", "07_ground_truth", "cannot be read")
        shutil.rmtree(compiled)  # nowhere to write to
        self.key("r")
        time.sleep(3)
        self.assertIsNone(self.program.poll(), self.error_text())
        self.assert_view_stays()
        self.quit()

    def test_panel_chooses_scenes_and_becomes_narrow(self):
        """Places are those of the panel's rows, 20 pixels apart, in a window of this size."""
        self.open("05_single_scattering", "--size", "400x300", "--scene", "noon", "--set", "view.steps=4", "--set", "light.steps=1",
                  "--validation", "sync")
        time.sleep(1.0)
        def press(x, y, to=None):
            self.xdotool("mousemove", "--window", self.window, str(x), str(y))
            time.sleep(0.5)
            self.xdotool("mousedown", "1")
            time.sleep(0.5)
            if to:
                self.xdotool("mousemove", "--window", self.window, *map(str, to))
                time.sleep(0.5)
            self.xdotool("mouseup", "1")
            time.sleep(0.5)
        press(200, 96)   # the list of scenes
        press(160, 181)  # its fifth, in the order of the alphabet
        picture = self.saved()
        done = self.run_chapter("05", "--headless", "--size", "64x36", "--scene", picture)
        self.assertIn("scene sunset", done.stdout)
        press(257, 24, (150, 24))  # its right edge, below its corner and in the title: no tooltip there
        view = rgb(read_png(picture))
        def parts(of):
            return [row[3 * 160:] for row in of], [row[:3 * 140] for row in of]
        self.key("h")
        self.assertTrue(self.in_time(lambda: rgb(self.screen("free.png")) == view), "without the panel there is the view")
        self.key("h")
        def narrow():
            right, left = parts(rgb(self.screen("narrow.png")))
            return right == parts(view)[0] and left != parts(view)[1]
        self.assertTrue(self.in_time(narrow), "right of the panel is the view")
        self.quit()

    def test_times_are_those_of_the_passes(self):
        """A march of a thousand instructions a pixel takes longer than the display of the same pixels, in a window too."""
        self.open("05_single_scattering", "--size", "160x90", "--scene", "noon", "--frames", "6")
        self.assertEqual(self.program.wait(timeout=60), 0, self.error_text())
        times = {line.split()[0]: float(line.split()[1]) for line in self.program.stdout if line.rstrip().endswith(" ms")}
        self.assertGreater(times["march"], 3 * times["display"])

    def test_the_truth_of_a_view_at_a_key(self):
        self.open("10_sky_view_lut", "--size", "64x36", "--scene", "noon", "--validation", "sync")
        self.key("t")
        line = self.program.stdout.readline()
        found = re.match(r"relative RMSE ([\d.]+) % against 32 frames of path tracing at 48x27; two of those differ by ([\d.]+) %", line)
        self.assertTrue(found, line)
        error, noise = map(float, found.groups())
        # The method's own error is far below the noise of so few paths; two noisy pictures differ by the root of two more.
        self.assertLess(error, noise)
        self.assertLess(noise, 10.0)
        self.quit()

    def test_lost_display_is_said(self):
        self.open("02_window", "--size", "320x200")
        self.server.kill()
        self.assertEqual(self.program.wait(timeout=30), 2)
        self.assertIn("display was lost", self.error_text())

    def test_dead_display_is_refused(self):
        done = self.run_chapter("02", DISPLAY=":4711")
        self.assert_refused(done, "display", "--headless")


if __name__ == "__main__":
    unittest.main()
