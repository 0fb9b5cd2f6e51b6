"""Bad input of every kind: one clear line, the right exit code, and nothing written."""
import os
import pathlib
import shutil
import subprocess
import unittest

from welkin_case import BUILD, CHAPTERS, ROOT, WelkinCase

SKY = "05"  # the chapter with every kind of input
RAYS = "altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg\n"


class CommandLine(WelkinCase):
    def refuse(self, arguments, *words, chapter=SKY, **keywords):
        self.assert_refused(self.run_chapter(chapter, "--headless", *arguments), *words, **keywords)

    def test_unknown_option(self):
        for chapter in CHAPTERS:
            self.refuse(["--colour"], "--colour", "--help", chapter=chapter[:2])

    def test_unknown_knob(self):
        self.refuse(["--set", "view.stepz=3"], "view.stepz", "view.steps")

    def test_knob_without_value(self):
        self.refuse(["--set", "view.steps"], "view.steps", "key=value")

    def test_knob_out_of_range(self):
        for value in ("0", "-1", "513", "1e30", "2.5"):
            self.refuse(["--set", f"view.steps={value}"], "view.steps", "1 to 512")
        self.refuse(["--set", "mie.g=1"], "mie.g", "-0.999 to 0.999")

    def test_knob_not_finite(self):
        for value in ("nan", "inf", "-inf", "", "0x10", "1,5", "1 2"):
            self.refuse(["--set", f"ground.albedo={value}"], "ground.albedo", "0 to 1")

    def test_knob_choice(self):
        self.refuse(["--set", "rule=simpson"], "simpson", "gauss_legendre")

    def test_sizes(self):
        for size in ("0x0", "0x10", "10x0", "-1x5", "99999x10", "16385x1", "ax1", "10", "10x", "1.5x2", "nanxnan", "10x10x10"):
            self.refuse(["--size", size], "--size", "1 to 16384")

    def test_numbers(self):
        self.refuse(["--frames", "0"], "--frames", "1 to")
        self.refuse(["--frames", "1e99"], "--frames")
        self.refuse(["--seed", "-1"], "--seed")
        self.refuse(["--time", "nan"], "--time")

    def test_choices(self):
        self.refuse(["--validation", "maybe"], "--validation", "off, on, sync")
        self.refuse(["--golden", "please"], "--golden", "check, update")
        self.refuse(["--golden", "update", "--seed", "7"], "--golden", "--seed")
        self.refuse(["--survey", "--size", "8x8"], "--survey", "--size")
        self.refuse(["--inject", "bug"], "--inject", "missing-barrier")
        self.refuse(["--dump", "soul", "x.exr"], "--dump", "picture")
        self.refuse(["--dump", "picture"], "--dump")
        self.refuse(["--gpu", "no such device"], "--gpu", "offered")
        self.refuse(["--gpu", "77"], "--gpu", "offered")
        self.refuse(["--view", "nowhere", "--scene", "noon"], "nowhere", "horizon")

    def test_options_that_go_together(self):
        self.refuse(["--probe", "rays.csv"], "--probe-out")
        self.refuse(["--output", "picture.jpg"], ".png or .exr")

    def test_a_chapter_without_a_sky_has_no_probe(self):
        (self.directory / "rays.csv").write_text(RAYS + "0,0,0,0\n")
        self.refuse(["--probe", "rays.csv", "--probe-out", "o.csv"], "no sky", chapter="01", files=["rays.csv"])


class Files(WelkinCase):
    def refuse_file(self, name, content, arguments, *words):
        path = self.directory / name
        path.unlink(missing_ok=True)
        if content is not None:
            path.write_bytes(content)
        done = self.run_chapter(SKY, "--headless", *arguments)
        self.assert_refused(done, *words, files=[name] if content is not None else [])

    def test_scene(self):
        good = (ROOT / "chapters/scenes/noon.toml").read_bytes()
        use = ["--scene", "bad.toml"]
        self.refuse_file("bad.toml", None, use, "bad.toml")
        self.refuse_file("bad.toml", b"", use, "bad.toml", "version")
        self.refuse_file("bad.toml", good[:200], use, "bad.toml:")
        self.refuse_file("bad.toml", bytes(range(256)) * 8, use, "bad.toml")
        self.refuse_file("bad.toml", good.replace(b"g = 0.8", b"g = nan"), use, "bad.toml:24:5", "0.999")
        self.refuse_file("bad.toml", good.replace(b"g = 0.8", b"g = 1.5"), use, "bad.toml:24:5", "0.999")
        self.refuse_file("bad.toml", good.replace(b"g = 0.8", b"gg = 0.8"), use, "bad.toml:24:1", "gg")
        self.refuse_file("bad.toml", good + b"\n[clouds]\n", use, "bad.toml:", "clouds")
        self.refuse_file("bad.toml", good.replace(b"version = 1", b"version = 9"), use, "version 9")
        self.refuse_file("bad.toml", None, ["--scene", "no_such_scene"], "no_such_scene", "sunset")
        self.refuse_file("bad.toml", None, ["--scene", "."], "director")

    def test_picture_as_scene(self):
        self.run_chapter("01", "--headless", "--size", "16x9", "--output", "good.png")
        good = (self.directory / "good.png").read_bytes()
        (self.directory / "good.png").unlink()
        use = ["--scene", "bad.png"]
        self.refuse_file("bad.png", None, use, "bad.png")
        self.refuse_file("bad.png", b"", use, "bad.png")
        self.refuse_file("bad.png", good[:100], use, "bad.png")
        self.refuse_file("bad.png", b"\x89PNG\r\n\x1a\n" + bytes(100), use, "bad.png")
        self.refuse_file("bad.png", good[:60] + bytes([good[60] ^ 255]) + good[61:], use, "bad.png")

    def test_a_picture_saved_again_by_another_program_restores(self):
        shutil.copy(ROOT / "tests" / "data" / "resaved.png", self.directory / "RESAVED.PNG")
        (self.directory / "there").mkdir()
        (self.directory / "link.png").symlink_to("there/picture.png")
        done = self.run_chapter(SKY, "--headless", "--size", "16x9", "--scene", "RESAVED.PNG", "--output", "link.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("scene sunset", done.stdout)
        self.assertTrue((self.directory / "link.png").is_symlink())
        self.assertEqual(self.files(), ["RESAVED.PNG", "link.png", "there/picture.png"])

    def test_rays_of_a_spreadsheet(self):
        """A byte order mark and CR LF change nothing."""
        plain = (RAYS + "0.0005,60,85,0\n").encode()
        for name, content in (("plain", plain), ("marked", b"\xef\xbb\xbf" + plain.replace(b"\n", b"\r\n"))):
            (self.directory / f"{name}.csv").write_bytes(content)
            done = self.run_chapter(SKY, "--headless", "--probe", f"{name}.csv", "--probe-out", f"{name}_out.csv")
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.directory / "plain_out.csv").read_bytes(), (self.directory / "marked_out.csv").read_bytes())

    def test_reference(self):
        use = ["--against", "bad.exr", "--size", "16x9"]
        self.refuse_file("bad.exr", None, use, "bad.exr")
        self.refuse_file("bad.exr", b"", use, "bad.exr")
        self.refuse_file("bad.exr", os.urandom(500), use, "bad.exr")

    def test_probe_rays(self):
        use = ["--probe", "rays.csv", "--probe-out", "out.csv"]
        for content, words in (
                (None, ["rays.csv"]), (b"", ["rays.csv"]), (RAYS.encode(), ["rays.csv"]), (os.urandom(300), ["rays.csv"]),
                (b"altitude_km\n1\n", ["view_zenith_deg"]), ((RAYS + "0,0,0\n").encode(), ["rays.csv:2"]),
                ((RAYS + "0,0,zero,0\n").encode(), ["rays.csv:2:5"]), ((RAYS + "0,nan,0,0\n").encode(), ["rays.csv:2:3"]),
                ((RAYS + "-1,0,0,0\n").encode(), ["altitude_km", "0 to"]), ((RAYS + "1000001,0,0,0\n").encode(), ["altitude_km", "0 to 1e+06"]), ((RAYS + "0,181,0,0\n").encode(), ["view_zenith_deg", "0 to 180"])):
            self.refuse_file("rays.csv", content, use, *words)

    def test_unwritable_output(self):
        (self.directory / "file").write_text("x")
        (self.directory / "folder.png").mkdir()
        for output in ("file/picture.png", "missing/picture.png", "folder.png", "/proc/picture.png"):
            done = self.run_chapter(SKY, "--headless", "--size", "8x8", "--output", output)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(output, done.stderr)
            self.assertEqual(self.files(), ["file"])
        for option, extension in (("--bench", "json"), ("--sweep", "csv")):
            done = self.run_chapter("03", "--headless", "--size", "8x8", option, f"missing/x.{extension}")
            self.assertEqual(done.returncode, 2)
            self.assertIn("missing", done.stderr)
            self.assertEqual(self.files(), ["file"])

    def test_a_picture_that_was_there_survives_a_failure(self):
        (self.directory / "p.png").write_text("precious")
        done = self.run_chapter(SKY, "--headless", "--size", "8x8", "--output", "p.png", "--set", "view.steps=0")
        self.assertEqual(done.returncode, 2)
        self.assertEqual((self.directory / "p.png").read_text(), "precious")


class Machine(WelkinCase):
    def test_no_vulkan_driver(self):
        # Both names: the loader reads the first since 1.3.207 and the second before.
        none = {"VK_DRIVER_FILES": "/nonexistent.json", "VK_ICD_FILENAMES": "/nonexistent.json", "WELKIN_EXPECT_SKIP": "1"}
        for chapter in CHAPTERS:
            self.assert_refused(self.run_chapter(chapter[:2], "--headless", **none), "skipped", "Vulkan", "mesa-vulkan-drivers", code=77)
        self.assert_refused(self.run_chapter(SKY, "--headless", "--require-gpu", **none), "Vulkan", "mesa-vulkan-drivers", code=2)

    def test_device_without_a_feature(self):
        for chapter in CHAPTERS:
            done = self.run_chapter(chapter[:2], "--headless", "--inject", "missing-feature")
            self.assert_refused(done, "wanted", "synchronization2", "offered", "docs/chapters/")

    def test_missing_shader(self):
        done = self.run_chapter(SKY, "--headless", WELKIN_SHADERS=str(self.directory))
        self.assert_refused(done, "shader", "build")


class FrontDoor(WelkinCase):
    def front(self, *arguments, program=ROOT / "welkin", **environment):
        inherited = {name: value for name, value in os.environ.items() if name != "WELKIN_WERROR"}  # asked of the build outside, not of these
        return subprocess.run([program, *map(str, arguments)], cwd=self.directory, capture_output=True, text=True, timeout=120,
                              env={**inherited, "WELKIN_BUILD": str(BUILD), **environment})

    def test_words(self):
        for arguments, word in ((["dance"], "dance"), (["run", "99"], "99"), (["compare"], "two chapters"), (["plot"], "table"), (["bench"], "chapter"),
                                (["compare", "04", "05", "--truth"], "--truth"), (["compare", "04", "05", "--truth=many"], "--truth many")):
            self.assert_refused(self.front(*arguments), word)

    def test_through_links_and_with_cdpath(self):
        wanted = self.front("list").stdout
        self.assertIn("01  first_light", wanted)
        (self.directory / "link").symlink_to(ROOT / "welkin")
        (self.directory / "again").symlink_to("link")
        (self.directory / "tree").symlink_to(ROOT)
        for program in ("./link", "./again", "tree/welkin"):
            for paths in ("", f"{self.directory}:/", "/"):
                done = self.front("list", program=program, CDPATH=paths)
                self.assertEqual((done.stdout, done.stderr), (wanted, ""), (program, paths))

    def test_compare_takes_options_in_both_forms(self):
        """In a tree of its own, whose build finds the programs of this one up to date."""
        tree, build = self.directory / "tree", self.directory / "tree" / "build"
        build.mkdir(parents=True)
        for name, target in ((tree / "chapters", ROOT / "chapters"), (build / "bin", BUILD / "bin"), (build / "shaders", BUILD / "shaders")):
            name.symlink_to(target)
        for name in ("welkin", "packages.txt"):
            shutil.copy(ROOT / name, tree)
        (build / ".packages-run").touch()
        (build / "build.ninja").write_text(f"build {' '.join(CHAPTERS)} welkin_compare: phony\n")
        for options, name in ((["--scene=sunset", "--view=wide", "--size=32x18", "--frames=3"], "sunset_wide"), (["--scene", "sunset", "--size", "32x18", "--frames", "3"], "sunset_sun"),
                              (["--size=32x18", "--truth=1"], "noon_horizon")):
            done = self.front("compare", "04", "05", *options, program=tree / "welkin", WELKIN_BUILD=str(build))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            report = tree / "out" / f"compare_04_air_05_single_scattering_{name}.md"
            self.assertIn(str(report), done.stdout)
            self.assertRegex(report.read_text(), "32 ?[x×] ?18")
            self.assertEqual("truth" in report.read_text(), "--truth=1" in options)

    def test_the_book_has_the_options(self):
        """docs/generated/options.txt is chapter 05's --help at 120 columns."""
        self.assertEqual(self.run_chapter("05", "--help", COLUMNS="120").stdout, (ROOT / "docs" / "generated" / "options.txt").read_text())

    def test_overview_and_list(self):
        self.assertIn("./welkin run", self.front().stdout)
        listed = self.front("list").stdout.splitlines()
        self.assertEqual([line.split()[0] + "_" + line.split()[1] for line in listed], CHAPTERS)


if __name__ == "__main__":
    unittest.main()
