"""Clouds from the command line: both forms of a probe's rays, bad files and bad places, and what lower chapters say."""
import csv
import math
import unittest

from welkin_case import WelkinCase

SCENE = """version = 1
[planet]
ground_radius_km = 6360.0
top_radius_km = 6460.0
[[view]]
name = "v"
"""
LAYER = """[[cloud]]
kind = "layer"
base_km = 1.5
top_km = 4.0
extinction_per_km = 0.5
"""
ABOVE = "altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg\n"
TANGENT = "east_km,north_km,up_km,view_zenith_deg,view_azimuth_deg,sun_zenith_deg,sun_azimuth_deg\n"


class Clouds(WelkinCase):
    def probe(self, rays, scene, *arguments):
        (self.directory / "scene.toml").write_text(SCENE + scene)
        (self.directory / "rays.csv").write_text(rays)
        return self.run_chapter("17", "--headless", "--scene", "scene.toml", "--probe", "rays.csv", "--probe-out", "out.csv", *arguments)

    def answers(self, rays, scene, *arguments):
        done = self.probe(rays, scene, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.directory / "out.csv", encoding="utf-8") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def test_rays_from_an_altitude(self):
        rows = self.answers(ABOVE + "0.0005,0,30,0\n2,0,30,0\n5,0,30,0\n5,180,30,0\n0.0005,100,30,0\n36000,180,30,40\n", LAYER)
        for row, length in zip(rows, (2.5, 2.0, 0.0, 2.5, 0.0, 2.5)):
            for c in "rgb":
                self.assertAlmostEqual(float(row[f"transmittance_{c}"]), math.exp(-0.5 * length), delta=1e-5)
                self.assertEqual(float(row[f"radiance_{c}"]), 0.0)

    def test_rays_in_the_tangent_frame(self):
        ball = "[[cloud]]\nkind = \"sphere\"\neast_km = 3.0\nnorth_km = -4.0\nup_km = 9.0\nradius_km = 0.5\nextinction_per_km = 2.0\n"
        rays = TANGENT + "3,-4,1,0,0,30,0\n3,-4,9,90,77,30,0\n1,-4,9,90,90,30,0\n1,-4,9,90,270,30,0\n3,-9,9,90,0,30,200\n3.3,-4,20,180,0,30,0\n"
        lengths = (1.0, 0.5, 1.0, 0.0, 1.0, 0.8)
        rows = self.answers(rays, ball)
        self.assertEqual(list(rows[0])[:7], TANGENT.strip().split(","))
        for row, length in zip(rows, lengths):
            self.assertAlmostEqual(float(row["transmittance_g"]), math.exp(-2.0 * length), delta=2e-5)

    def test_places_and_columns_that_are_none(self):
        for rays, line in ((TANGENT + "0,0,-1,0,0,30,0\n", "row 1: altitude -1 km; accepted is a place from 0 to"),
                           (TANGENT + "2e6,0,1,0,0,30,0\n", "row 1: east_km is 2e+06; accepted is"),
                           (TANGENT + "0,0,1,200,0,30,0\n", "row 1: view_zenith_deg is 200; accepted is 0 to 180"),
                           ("east_km,north_km\n0,0\n", "up_km")):
            done = self.probe(rays, LAYER)
            self.assertEqual(done.returncode, 2, rays)
            self.assertIn(line, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertFalse((self.directory / "out.csv").exists())

    def test_files_that_are_none(self):
        grid = "[[cloud]]\nkind = \"grid\"\nup_km = 1.0\nsize_km = [1, 1, 1]\nfile = \"a.grid\"\n"
        noise = "[[cloud]]\nkind = \"noise\"\nbase_km = 1\ntop_km = 2\nweather = \"a.png\"\n"
        (self.directory / "a.grid").write_bytes(b"welkin-grid 1" + b" " * 300)
        (self.directory / "a.png").write_bytes(b"no picture")
        for scene, name in ((grid, "a.grid"), (noise, "a.png"), (grid.replace("a.grid", "missing.grid"), "missing.grid")):
            done = self.probe(ABOVE + "0,0,0,0\n", scene)
            self.assertEqual(done.returncode, 2, scene)
            self.assertIn(name, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            done = self.run_chapter("17", "--headless", "--scene", "scene.toml", "--size", "16x9", "--output", "out.png")
            self.assertEqual(done.returncode, 2, scene)
            self.assertFalse((self.directory / "out.png").exists())

    def test_a_chapter_below_says_that_it_draws_none(self):
        (self.directory / "scene.toml").write_text(SCENE + LAYER)
        done = self.run_chapter("05", "--headless", "--scene", "scene.toml", "--size", "16x9", "--explain")
        self.assertRegex(done.stdout, "clouds +off +in the scene, drawn from chapter 17 on")


if __name__ == "__main__":
    unittest.main()
