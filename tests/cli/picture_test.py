"""Pictures as files: --supersample is the average of the large picture, and a failing golden is shown."""
import math
import shutil
import struct
import unittest
import zlib

from welkin_case import BUILD, WelkinCase, read_png


def read_exr(path):
    """(width, height, {channel: rows of floats}) of the kind of file the programs write: float, scan lines, ZIP."""
    data = path.read_bytes()
    position, attributes = 8, {}
    while data[position]:
        name, kind, rest = data[position:].split(b"\0", 2)
        position += len(name) + len(kind) + 2
        size, = struct.unpack_from("<I", data, position)
        attributes[name] = data[position + 4:position + 4 + size]
        position += 4 + size
    x0, y0, x1, y1 = struct.unpack("<4i", attributes[b"dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    position += 1 + 8 * ((height + 15) // 16)
    channels = {c: [] for c in "BGR"}
    for first in range(0, height, 16):
        lines = min(16, height - first)
        _, size = struct.unpack_from("<iI", data, position)
        block, full = data[position + 8:position + 8 + size], lines * width * 12
        position += 8 + size
        if size < full:
            packed = bytearray(zlib.decompress(block))
            for i in range(1, full):
                packed[i] = (packed[i - 1] + packed[i] - 128) & 255
            block = bytes(packed[i // 2 + (i % 2) * ((full + 1) // 2)] for i in range(full))
        values = struct.unpack(f"<{full // 4}f", block)
        for line in range(lines):
            for c, channel in enumerate("BGR"):
                channels[channel].append(values[(3 * line + c) * width:(3 * line + c + 1) * width])
    return width, height, channels


def linear(value):
    value /= 255.0
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def encoded(value):
    return 255.0 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055)


class Supersample(WelkinCase):
    def draw(self, size, output, *arguments):
        done = self.run_chapter("05", "--headless", "--scene", "sunset", "--size", size, "--output", output, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.directory / output

    def test_linear_light_is_averaged(self):
        width, height, small = read_exr(self.draw("20x12", "small.exr", "--supersample", "3"))
        self.assertEqual((width, height), (20, 12))
        width, height, large = read_exr(self.draw("60x36", "large.exr"))
        self.assertEqual((width, height), (60, 36))
        for channel in "RGB":
            for y in range(12):
                for x in range(20):
                    mean = sum(large[channel][3 * y + j][3 * x + i] for j in range(3) for i in range(3)) / 9
                    self.assertTrue(math.isclose(small[channel][y][x], mean, rel_tol=1e-6), (channel, x, y))

    def test_display_values_are_averaged_as_light(self):
        _, _, n, small = read_png(self.draw("40x24", "small.png", "--supersample=2"))
        _, _, m, large = read_png(self.draw("80x48", "large.png"))
        worst = mixed = 0
        for y in range(24):
            for x in range(40):
                for c in range(3):
                    four = [large[2 * y + j][(2 * x + i) * m + c] for j in range(2) for i in range(2)]
                    worst = max(worst, abs(small[y][x * n + c] - encoded(sum(map(linear, four)) / 4)))
                    mixed += max(four) - min(four) > 20
        self.assertLess(worst, 0.51, "rounded to nearest")
        self.assertGreater(mixed, 20, "there are edges, where the two ways to average differ")

    def test_it_restores_and_keeps_its_size(self):
        picture = self.draw("40x24", "p.png", "--supersample", "2", "--view", "wide")
        done = self.run_chapter("05", "--headless", "--scene", picture, "--size", "80x48", "--output", "large.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.draw("80x48", "same.png", "--view", "wide")
        self.assertEqual(read_png(self.directory / "large.png"), read_png(self.directory / "same.png"))

    def test_refusals(self):
        for value in ("0", "9", "1.5", "two", "-1"):
            self.assert_refused(self.run_chapter("05", "--supersample", value), "--supersample", "1 to 8")
        self.assert_refused(self.run_chapter("05", "--supersample", "8", "--size", "16384x64"), "--supersample 8 of 16384x64", "131072x512", "a side on")
        self.assert_refused(self.run_chapter("05", "--supersample", "2", "--golden", "check"), "--supersample", "--golden")


class Golden(WelkinCase):
    def test_a_failing_golden_is_shown(self):
        shutil.copytree(BUILD / "shaders", self.directory / "build" / "shaders")
        done = self.run_chapter("04", "--headless", "--golden", "check", "--inject", "nan", WELKIN_SHADERS=str(self.directory / "build" / "shaders"))
        self.assertEqual(done.returncode, 1, done.stderr)
        shown = [line.split(": ")[-1] for line in done.stdout.splitlines() if "expected, got, difference" in line]
        self.assertEqual(len(shown), done.stdout.count("DIFFERS"))
        self.assertGreater(len(shown), 0)
        width, height, channels, rows = read_png(shown[0])
        self.assertEqual((width, height), (3 * 128 + 8, 72))
        magenta = sum(bytes(row[x * channels:x * channels + 3]) == b"\xff\0\xff" for row in rows for x in range(264, width))
        self.assertGreater(magenta, 0, "the difference shows what is not finite")


if __name__ == "__main__":
    unittest.main()
