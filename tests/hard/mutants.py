#!/usr/bin/env python3
"""Evidence that the tests of chapter 05 see: each mutant is one wrong constant, sign or term in one shader, and a named
test must fail with it and pass without it.

mutants.py [--write FILE] [NAME …]     needs the built tests (WELKIN_BUILD) and glslangValidator

For each mutant the shaders are copied, one text is replaced (which must be there exactly once), the harness shaders are
compiled from the copy, and gpu_tests runs with WELKIN_SHADERS pointing at them. Nothing in the tree or in the build is
touched. Exit codes: 0 all caught, 1 one escaped, 2 a mutant no longer fits the source, 77 no Vulkan device.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("WELKIN_BUILD", ROOT / "build"))
HARNESSES = ("05_ray.comp", "05_parts.comp")
DEFAULTS = "truth: default steps hold 1 % on every row"

# name, file under shaders/, text, what it becomes, test that must fail
MUTANTS = [
    ("the sun is up wherever its line passes 1 km under ground", "05_single_scattering/march.glsl",
     "sqrt((1.0 - mu_sun) * (1.0 + mu_sun))) >= 0.0;", "sqrt((1.0 - mu_sun) * (1.0 + mu_sun))) >= -1.0;",
     "sun above the horizon: the same answer as in double"),
    ("the planet casts its shadow towards the sun, too", "05_single_scattering/adapted_march.glsl",
     "if (ray.nu > 0.0) leave = min(leave, crossing);", "", DEFAULTS),
    ("altitude along a ray without its curvature", "03_planet_and_rays/ray_sphere.glsl",
     "return altitude_km + t_km * (2.0 * r * mu + t_km) / max(r_t + r, 1.0e-20);", "return altitude_km + t_km * mu;", DEFAULTS),
    ("1 + g^2 above the fraction of the phase function", "04_air/phase.glsl",
     "* (1.0 - g) * (1.0 + g) / (d * sqrt(d));", "* (1.0 + g * g) / (d * sqrt(d));", DEFAULTS),
    ("Rayleigh's phase function with the isotropic constant", "04_air/phase.glsl",
     "return 0.059683103659460751 * (1.0 + nu * nu);", "return 0.079577471545947668 * (1.0 + nu * nu);", DEFAULTS),
    ("no ozone in the optical depth", "04_air/medium.glsl", " + vec3(atmosphere.ozone) * density.z;", ";", DEFAULTS),
    ("aerosol that absorbs nothing", "04_air/medium.glsl",
     "scattering.mie = vec3(atmosphere.mie_scattering)", "scattering.mie = vec3(atmosphere.mie_extinction)", DEFAULTS),
    ("a Gauss weight with two digits exchanged", "05_single_scattering/light_path.glsl",
     "const vec4 kGauss4Weight = vec4(0.173927422568726929,", "const vec4 kGauss4Weight = vec4(0.137927422568726929,", DEFAULTS),
    ("the column up to a Gauss node with a wrong sign", "05_single_scattering/adapted_march.glsl",
     "vec4(0.086963711284363, -0.026604180084999,", "vec4(0.086963711284363, 0.026604180084999,", DEFAULTS),
    ("the error function with two digits exchanged", "05_single_scattering/light_path.glsl",
     "t * (0.4732278677 +", "t * (0.4372278677 +", "hard: a sun path that dips to the ground"),
    ("segments of equal length under the nonuniform rule", "05_single_scattering/march.glsl",
     "segment.width = (end - begin) * (end + begin);", "segment.width = end - begin;", "truth: the segments of every rule tile the ray"),
    ("the zenith turns the wrong way where a ray from space enters", "05_single_scattering/march.glsl",
     "max(ray.sine * mu_entry - ray.mu * sine_entry, 0.0)", "-max(ray.sine * mu_entry - ray.mu * sine_entry, 0.0)",
     "hard: seen from the Moon*"),
    ("ground lit without the cosine", "05_single_scattering/single_scattering.glsl",
     "* (mu_sun * 0.31830988618379067);", "* 0.31830988618379067;", DEFAULTS),
    ("the series of the mean transmittance with a wrong sign", "05_single_scattering/march.glsl",
     "1.0 - tau * (0.5 - tau", "1.0 - tau * (0.5 + tau", "hard: the mean transmittance of almost no air"),
    ("the sun's disc without its normalisation", "05_single_scattering/sun_disc.glsl",
     "* (alpha + vec3(2.0, 2.0, 2.0)) * 0.5;", ";", "sun disc: as a whole it sends exactly the irradiance"),
]


def compile_harnesses(shaders, output):
    (output / "tests").mkdir(parents=True)
    for name in HARNESSES:
        done = subprocess.run([os.environ.get("GLSLANG_VALIDATOR", "glslangValidator"), "-V", "--target-env", "vulkan1.2", "--quiet",
                               f"-I{shaders}", "-o", output / "tests" / f"{name}.spv", ROOT / "tests/gpu/shaders" / name],
                              capture_output=True, text=True)
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
    parser.add_argument("names", nargs="*", help="only mutants whose name contains one of these")
    arguments = parser.parse_args()
    chosen = [m for m in MUTANTS if not arguments.names or any(n in m[0] for n in arguments.names)]
    start, lines, failed, stale = time.monotonic(), [], 0, 0
    with tempfile.TemporaryDirectory(prefix="welkin-mutants-") as directory:
        work = Path(directory)
        shutil.copytree(ROOT / "shaders", work / "shaders")
        message = compile_harnesses(work / "shaders", work / "healthy")
        if message:
            sys.exit(f"the unmutated shaders do not compile:\n{message}")
        healthy = {}
        for test in dict.fromkeys(m[4] for m in chosen):
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
                message = compile_harnesses(work / "shaders", work / f"mutant{number}")
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
