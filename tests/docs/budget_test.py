"""The budgets that keep the code readable, and the arrows that only go down."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CODE = [path for folder in ("chapters", "common", "shaders", "tests", "docs") for path in (ROOT / folder).rglob("*")
        if path.suffix in {".cpp", ".hpp", ".h", ".glsl", ".comp", ".vert", ".frag", ".py", ".cmake", ".mjs"} and "node_modules" not in path.parts
        and "dist" not in path.parts and "cache" not in path.parts]


def lines(path):
    return len(path.read_text().splitlines())


class Budgets(unittest.TestCase):
    def test_no_file_over_400_lines(self):
        self.assertEqual({str(p.relative_to(ROOT)): lines(p) for p in CODE if lines(p) > 400}, {})

    def test_common_fits(self):
        """Lines that are neither blank nor only a comment: documentation is not what the budget is there to limit."""
        def is_code(line):
            return bool(line.strip()) and not line.strip().startswith(("//", "#!", '"""'))
        total = sum(sum(map(is_code, p.read_text().splitlines())) for p in CODE if p.relative_to(ROOT).parts[0] == "common")
        self.assertLessEqual(total, 6651)  # a ratchet on the way to 4,400
        self.assertGreater(total, 1000, "the files were found")

    def test_main_tells_a_story(self):
        mains = list((ROOT / "chapters").glob("*/main.cpp"))
        self.assertGreaterEqual(len(mains), 5)
        self.assertEqual({str(p): lines(p) for p in mains if lines(p) > 150}, {})

    def test_front_door_fits(self):
        self.assertLessEqual(lines(ROOT / "welkin"), 200)

    def test_every_file_opens_with_what_it_is_for(self):
        bare = [str(p.relative_to(ROOT)) for p in CODE if not re.match(r'(#!.*\n)?("""|//|#|/\*)', p.read_text())]
        self.assertEqual(bare, [])

    def test_chapters_use_only_lower_numbers(self):
        wrong = []
        for path in CODE:
            relative = path.relative_to(ROOT)
            own = re.match(r"(\d\d)_", relative.parts[1]) if relative.parts[0] in ("chapters", "shaders") else None
            if relative.parts[0] in ("tests", "docs"):
                continue
            for used in re.findall(r'#include "(?:chapters/)?(\d\d)_', path.read_text()):
                if own is None or int(used) > int(own.group(1)):
                    wrong.append(f"{relative} includes chapter {used}")
        self.assertEqual(wrong, [])

    def test_nothing_of_the_workshop_is_named(self):
        names = ("../" + "shared", "/work" + "/", "registry." + "npmjs", "deb." + "debian.org")
        found = [f"{p.relative_to(ROOT)}: {name}" for p in [*CODE, *ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "chapters").glob("*.md"), ROOT / "welkin"]
                 for name in names if name in p.read_text()]
        self.assertEqual(found, [])


def functions(path):
    """(name, lines from signature to closing brace) of every function of a C++ or GLSL file, counted by braces: what has
    parentheses before its brace and stands in no other function is one."""
    literals = r'//[^\n]*|/\*.*?\*/|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|^[ \t]*#(?:\\\n|[^\n])*'
    text = re.sub(literals, lambda match: "\n" * match.group().count("\n"), path.read_text(), flags=re.DOTALL | re.MULTILINE)
    found, head, begin, line, inside = [], "", 1, 1, 0  # inside: open braces of the function at hand
    for c in text:
        line += c == "\n"
        if inside:
            inside += (c == "{") - (c == "}")
            if inside == 0:
                name = re.findall(r"([\w:~]+)\s*\(", head)
                found.append((name[0] if name else "?", line - begin + 1))
                head = ""
        elif c == "{" and "(" in head and not re.search(r"=\s*$", head):
            inside = 1
        elif c in "{};":
            head = ""
        else:
            if not head.strip():
                begin = line
            head += c
    return found


class Style(unittest.TestCase):
    SOURCES = [path for path in CODE if path.relative_to(ROOT).parts[0] in ("chapters", "common", "shaders", "tests")
               and path.suffix in {".cpp", ".hpp", ".h", ".glsl", ".comp", ".vert", ".frag"}]

    def test_cpp_is_formatted(self):
        import shutil
        import subprocess
        if shutil.which("clang-format") is None:
            self.skipTest("no clang-format")
        files = [path for path in self.SOURCES if path.suffix in {".cpp", ".hpp"}]
        self.assertGreater(len(files), 100, "the files were found")
        done = subprocess.run(["clang-format", "--dry-run", "--Werror", "-style=file", *files], cwd=ROOT, capture_output=True, text=True)
        wrong = sorted({line.split(":")[0].removeprefix(f"{ROOT}/") for line in done.stderr.splitlines() if "clang-formatted" in line})
        self.assertEqual(wrong, [], "mend them with: clang-format -i FILE")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_no_function_over_80_lines(self):
        lengths = {f"{path.relative_to(ROOT)}: {name}": count for path in self.SOURCES for name, count in functions(path)}
        self.assertGreater(len(lengths), 1000, "the functions were found")
        self.assertEqual({name: count for name, count in lengths.items() if count > 80}, {})

    def test_front_door_is_shellcheck_clean(self):
        import shutil
        import subprocess
        if shutil.which("shellcheck") is None:
            self.skipTest("no shellcheck")
        done = subprocess.run(["shellcheck", ROOT / "welkin", ROOT / ".ci" / "run", ROOT / "docs" / "generate.sh"], capture_output=True, text=True)
        self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    unittest.main()
