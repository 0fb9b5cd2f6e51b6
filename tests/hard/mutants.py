"""Evidence that the tests see: each mutant is one wrong constant, sign or term in one shader, and a named test must fail
with it and pass without it.

mutants.py NN [--tested] [--write FILE] [NAME …]     needs the built tests (WELKIN_BUILD) and glslangValidator

The mutants of a chapter are in mutants/NN.py. For each the shaders are copied, one text is replaced (which must be there
exactly once), and gpu_tests runs with WELKIN_SHADERS pointing at a directory of the build's programs in which those that
include the file are named pipes: what the test opens is compiled from the copy then, and nothing else is. Nothing in the
tree or in the build is touched.
--tested: gpu_tests runs beside this and says whether the tests pass without a mutant; they are not run for that again.
Exit codes: 0 all caught, 1 one escaped, 2 a mutant no longer fits the source, 77 no Vulkan device.
"""
import argparse
import contextlib
import errno
import os
import runpy
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("WELKIN_BUILD", ROOT / "build")).resolve()
GLSLANG = os.environ.get("GLSLANG_VALIDATOR", "glslangValidator")


def programs():
    """Every compiled shader of the build: its SPIR-V and the sources it was made from, by their place under shaders/."""
    found = []
    for spirv in sorted((BUILD / "shaders").rglob("*.spv")):
        dependencies = Path(f"{spirv}.d").read_text(encoding="utf-8").replace("\\\n", " ").split(":", 1)[1].split()
        found.append((spirv.relative_to(BUILD / "shaders"), [Path(d).resolve() for d in dependencies]))
    return found


class Mutated:
    """The build's programs under `directory`; those that include the mutated file are compiled when they are opened."""

    def __init__(self, found, file, shaders, directory):
        self.shaders, self.pending, self.message = shaders, {}, ""
        for spirv, sources in found:
            target = directory / spirv
            target.parent.mkdir(parents=True, exist_ok=True)
            if file is None or (ROOT / "shaders" / file).resolve() not in sources:
                target.symlink_to(BUILD / "shaders" / spirv)
                continue
            os.mkfifo(target)
            source = sources[0]
            self.pending[target] = shaders / source.relative_to(ROOT / "shaders") if source.is_relative_to(ROOT / "shaders") else source

    def serve(self):
        """Compiles what somebody waits to read. Later readers find the file in the pipe's place."""
        for target, source in list(self.pending.items()):
            try:
                pipe = os.open(target, os.O_WRONLY | os.O_NONBLOCK)
            except OSError as error:
                if error.errno != errno.ENXIO:
                    raise
                continue  # no reader
            fresh = Path(f"{target}.new")
            done = subprocess.run([GLSLANG, "-V", "--target-env", "vulkan1.2", "--quiet",
                                   f"-I{self.shaders}", "-o", fresh, source], capture_output=True, text=True)
            if done.returncode:
                self.message = done.stdout + done.stderr
                fresh.write_bytes(b"")
            os.replace(fresh, target)
            os.set_blocking(pipe, True)
            with contextlib.suppress(BrokenPipeError), os.fdopen(pipe, "wb") as written:  # a reader that was killed
                written.write(target.read_bytes())
            del self.pending[target]


def run_test(name, directory, mutated):
    """(failed, output) of one named test; ends the program with 77 where no device is."""
    with tempfile.TemporaryFile("w+") as output:
        process = subprocess.Popen([BUILD / "bin/gpu_tests", name, "--abort", "-w", "NoTests"], stdout=output, stderr=subprocess.STDOUT,
                                   env={**os.environ, "WELKIN_SHADERS": str(directory)})
        end = time.monotonic() + 120
        try:
            while process.poll() is None:
                mutated.serve()
                time.sleep(0.004)
                if time.monotonic() > end:
                    process.kill()
        finally:  # it may wait for a pipe that nobody will write
            process.kill()
            process.wait()
        output.seek(0)
        text = output.read()
    if process.returncode == 77:
        print(text.strip())
        sys.exit(77)
    return process.returncode != 0, text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", metavar="FILE", help="also write the table there")
    parser.add_argument("--tested", action="store_true", help="take the tests to pass without a mutant")
    parser.add_argument("chapter", help="two digits")
    parser.add_argument("names", nargs="*", help="only mutants whose name contains one of these")
    arguments = parser.parse_intermixed_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # as any exit: what was begun is cleaned up
    if not (BUILD / "bin" / "gpu_tests").exists():
        parser.error(f"no built tests in {BUILD}; see ./welkin test, or set WELKIN_BUILD")
    if shutil.which(GLSLANG) is None:
        parser.error(f"no shader compiler '{GLSLANG}'")
    lists = Path(__file__).with_suffix("")
    if not (lists / f"{arguments.chapter}.py").exists():
        parser.error(f"no mutants of chapter {arguments.chapter}; there are: {', '.join(sorted(p.stem for p in lists.glob('*.py')))}")
    mutants = runpy.run_path(str(lists / f"{arguments.chapter}.py"))["MUTANTS"]
    found = programs()
    chosen = [m for m in mutants if not arguments.names or any(n in m[0] for n in arguments.names)]
    if not chosen:
        parser.error(f"no mutant's name contains {' or '.join(arguments.names)}")
    start, lines, failed, stale = time.monotonic(), [], 0, 0
    with tempfile.TemporaryDirectory(prefix="welkin-mutants-") as directory:
        work = Path(directory)
        shutil.copytree(ROOT / "shaders", work / "shaders")
        (work / "tests").symlink_to(ROOT / "tests")  # harnesses include texts from there, beside shaders/
        whole = Mutated(found, None, work / "shaders", work / "healthy")
        healthy = dict.fromkeys((m[4] for m in chosen), True)
        for test in () if arguments.tested else healthy:
            broken, output = run_test(test, work / "healthy", whole)
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
                mutated = Mutated(found, file, work / "shaders", work / f"mutant{number}")
                broken, output = run_test(test, work / f"mutant{number}", mutated)
                path.write_text(source, encoding="utf-8")
                if mutated.message:
                    verdict, stale = "STALE: does not compile: " + mutated.message.strip().splitlines()[-1], stale + 1
                elif not healthy[test]:
                    verdict, failed = "NOT JUDGED: the test fails without it", failed + 1
                elif not broken or "FAILED" not in output:
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
