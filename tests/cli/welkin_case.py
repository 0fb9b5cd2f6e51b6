"""What the command-line tests share: where the programs are, how to run one, and small readers for what they write."""
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("WELKIN_BUILD", ROOT / "build"))
CHAPTERS = sorted(path.name for path in (ROOT / "chapters").glob("[0-9][0-9]_*")
                  if (ROOT / "docs" / "chapters" / f"{path.name}.md").exists())  # without its page it is not whole yet


class WelkinCase(unittest.TestCase):
    """Runs programs in an empty directory of its own, so that what they write (or must not write) is seen."""

    def setUp(self):
        self.directory = pathlib.Path(tempfile.mkdtemp(prefix="welkin-"))
        self.addCleanup(shutil.rmtree, self.directory, ignore_errors=True)

    def run_chapter(self, chapter, *arguments, timeout=120, **environment):
        program = next(name for name in CHAPTERS if name.startswith(chapter))
        variables = {**os.environ, **environment}
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):  # a test that wants a display says so
            if name not in environment:
                variables.pop(name, None)
        done = subprocess.run([BUILD / "bin" / program, *map(str, arguments)], cwd=self.directory, env=variables,
                              capture_output=True, text=True, timeout=timeout, errors="replace")
        if done.returncode == 77 and "WELKIN_EXPECT_SKIP" not in environment:
            self.skipTest(done.stderr.strip())
        return done

    def files(self):
        return sorted(str(path.relative_to(self.directory)) for path in self.directory.rglob("*") if path.is_file())

    def assert_refused(self, done, *words, code=2, files=()):
        """One clear line on standard error with all the words, the exit code, and no file but those that were there."""
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        lines = done.stderr.strip().splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        for word in words:
            self.assertIn(word, lines[0])
        self.assertEqual(self.files(), sorted(files))


def read_png(path):
    """(width, height, rows of raw bytes) of an 8-bit PNG: filters undone, independent of the project's own reader."""
    data = pathlib.Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
    position, packed = 8, b""
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and colour in (2, 6)
            channels = 3 if colour == 2 else 4
        elif kind == b"IDAT":
            packed += body
        position += 12 + length
    raw, stride, rows = zlib.decompress(packed), width * channels, []
    previous = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left = line[x - channels] if x >= channels else 0
            up = previous[x]
            corner = previous[x - channels] if x >= channels else 0
            if kind == 1:
                line[x] = (line[x] + left) & 255
            elif kind == 2:
                line[x] = (line[x] + up) & 255
            elif kind == 3:
                line[x] = (line[x] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
                line[x] = (line[x] + (left, up, corner)[distances.index(min(distances))]) & 255
        rows.append(line)
        previous = line
    return width, height, channels, rows


def rgb(picture):
    width, height, channels, rows = picture
    return [bytes(row[x * channels + c] for x in range(width) for c in range(3)) for row in rows]


def carried(path):
    """The scene's text in a picture."""
    data, position = pathlib.Path(path).read_bytes(), 8
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        if kind == b"iTXt" and body.startswith(b"welkin.scene\0"):
            packed = body[len(b"welkin.scene\0")] == 1
            text = body[len(b"welkin.scene\0") + 2:].split(b"\0", 2)[2]
            return (zlib.decompress(text) if packed else text).decode()
        if kind == b"tEXt" and body.startswith(b"welkin.scene\0"):
            return body.split(b"\0", 1)[1].decode()
        position += 12 + length
    raise AssertionError(f"{path} carries no scene")
