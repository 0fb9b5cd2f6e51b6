"""Evidence that the tests see: each mutant is one wrong constant, sign or term in one shader, and a named test must fail
with it and pass without it.

mutants.py NN [--tested] [--write FILE] [NAME …]     needs the built tests (WELKIN_BUILD) and glslangValidator

The mutants of a chapter are in mutants/NN.py. For each the shaders are copied, one text is replaced (which must be there
exactly once), every program up to that chapter that includes the file is compiled from the copy beside the healthy others
(later chapters' are not: they are many, and a mutant whose test needed one would be seen to escape), and
gpu_tests runs with WELKIN_SHADERS pointing at them. Nothing in the tree or in the build is touched.
--tested: gpu_tests runs beside this and says whether the tests pass without a mutant; they are not run for that again.
Exit codes: 0 all caught, 1 one escaped, 2 a mutant no longer fits the source, 77 no Vulkan device.
"""
import argparse
import os
import re
import runpy
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("WELKIN_BUILD", ROOT / "build"))


def programs():
    """Every compiled shader of the build: its SPIR-V and the sources it was made from, by their place under shaders/."""
    found = []
    for spirv in sorted((BUILD / "shaders").rglob("*.spv")):
        dependencies = Path(f"{spirv}.d").read_text(encoding="utf-8").replace("\\\n", " ").split(":", 1)[1].split()
        found.append((spirv.relative_to(BUILD / "shaders"), [Path(d).resolve() for d in dependencies]))
    return found


def compile_programs(found, mutated, chapter, shaders, output):
    """The build's programs under `output`, those up to the chapter that include the mutated file compiled from the copy."""
    for spirv, sources in found:
        target = output / spirv
        target.parent.mkdir(parents=True, exist_ok=True)
        number = re.search(r"(?:^|/)(\d\d)_", spirv.as_posix())
        if mutated is None or number and number[1] > chapter or (ROOT / "shaders" / mutated).resolve() not in sources:
            target.symlink_to(BUILD / "shaders" / spirv)
            continue
        source = sources[0]
        if source.is_relative_to(ROOT / "shaders"):
            source = shaders / source.relative_to(ROOT / "shaders")
        done = subprocess.run([os.environ.get("GLSLANG_VALIDATOR", "glslangValidator"), "-V", "--target-env", "vulkan1.2", "--quiet",
                               f"-I{shaders}", "-o", target, source], capture_output=True, text=True)
        if done.returncode:
            return done.stdout + done.stderr
    return ""


def run_test(name, spirv):
    """(failed, output) of one named test; ends the program with 77 where no device is."""
    done = subprocess.run([BUILD / "bin/gpu_tests", name, "--abort", "-w", "NoTests"], capture_output=True, text=True,
                          env={**os.environ, "WELKIN_SHADERS": str(spirv)}, timeout=120)
    if done.returncode == 77:
        print(done.stderr.strip())
        sys.exit(77)
    return done.returncode != 0, done.stdout + done.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", metavar="FILE", help="also write the table there")
    parser.add_argument("--tested", action="store_true", help="take the tests to pass without a mutant")
    parser.add_argument("chapter", help="two digits")
    parser.add_argument("names", nargs="*", help="only mutants whose name contains one of these")
    arguments = parser.parse_args()
    lists = Path(__file__).with_suffix("")
    if not (lists / f"{arguments.chapter}.py").exists():
        parser.error(f"no mutants of chapter {arguments.chapter}; there are: {', '.join(sorted(p.stem for p in lists.glob('*.py')))}")
    mutants = runpy.run_path(str(lists / f"{arguments.chapter}.py"))["MUTANTS"]
    found = programs()
    chosen = [m for m in mutants if not arguments.names or any(n in m[0] for n in arguments.names)]
    start, lines, failed, stale = time.monotonic(), [], 0, 0
    with tempfile.TemporaryDirectory(prefix="welkin-mutants-") as directory:
        work = Path(directory)
        shutil.copytree(ROOT / "shaders", work / "shaders")
        (work / "tests").symlink_to(ROOT / "tests")  # harnesses include ../tests/gpu/shaders/atmosphere_of.glsl
        compile_programs(found, None, arguments.chapter, work / "shaders", work / "healthy")
        healthy = dict.fromkeys((m[4] for m in chosen), True)
        for test in () if arguments.tested else healthy:
            broken, output = run_test(test, work / "healthy")
            healthy[test] = not broken
            if broken:
                print(f"'{test}' does not pass without a mutant:\n{output}", file=sys.stderr)
        for number, (name, file, text, replacement, test) in enumerate(chosen):
            path = work / "shaders" / file
            source = path.read_text(encoding="utf-8")
            verdict = "caught"
            if source.count(text) != 1:
                verdict, stale = f"STALE: the text is there {source.count(text)} times", stale + 1
            else:
                path.write_text(source.replace(text, replacement), encoding="utf-8")
                message = compile_programs(found, file, arguments.chapter, work / "shaders", work / f"mutant{number}")
                path.write_text(source, encoding="utf-8")
                if message:
                    verdict, stale = "STALE: does not compile: " + message.strip().splitlines()[-1], stale + 1
                elif not healthy[test]:
                    verdict, failed = "NOT JUDGED: the test fails without it", failed + 1
                else:
                    broken, output = run_test(test, work / f"mutant{number}")
                    if not broken or "FAILED" not in output:
                        verdict, failed = "ESCAPED", failed + 1
            line = f"{name} ({file}) -> {test}: {verdict}"
            print(line, flush=True)
            lines.append(line)
    passed = len(chosen) - failed - stale
    last = f"{passed} passed, {failed + stale} failed"
    print(f"{time.monotonic() - start:.0f} s")
    print(last)
    if arguments.write:
        temporary = Path(arguments.write + ".new")
        temporary.write_text("mutant (file) -> test that must fail with it and pass without it: what happened\n\n" +
                             "\n".join(lines + ["", last]) + "\n", encoding="utf-8")
        os.replace(temporary, arguments.write)
    return 2 if stale else 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
