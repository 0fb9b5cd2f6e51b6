#!/usr/bin/env python3
"""Every method of the book on one chart: error against Monte Carlo, time per frame.

accuracy.py NAME [--size 1920x1080]     measures, writes docs/generated/accuracy_NAME.csv, and draws it where gnuplot is
accuracy.py NAME --draw                 draws docs/pictures/accuracy_NAME.svg from that table and measures nothing

Errors: each chapter's --probe for the rays of tests/data/multiple_scattering_*.csv (all orders, Cornette-Shanks, ground
albedo 0.3), rows known to 1 %, the sun above -4 degrees and the ray more than 0.5 degrees from the horizon. A method whose
picture is not the sky along single rays (chapter 11's terrain) has a time and no error here. Times: --bench at --size, mean
of three views. Needs the built chapters (WELKIN_BUILD); to draw, gnuplot. Python's standard library only.
"""
import argparse
import csv
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from plot import pareto

ROOT = Path(__file__).resolve().parents[1]
BUILD = Path(os.environ.get("WELKIN_BUILD", ROOT / "build"))
VIEWS = (("noon", "horizon"), ("sunset", "sun"), ("alien", "horizon"))
PUBLISHED = "multiple_scattering.method=published"
METHODS = (  # name, chapter, settings, settings of --probe alone (None: no rays to ask for)
    ("05 one order", "05_single_scattering", (), ()),
    ("08 one order (table)", "08_transmittance_lut", (), ()),
    ("09 march (published table)", "09_multiple_scattering_lut", (PUBLISHED,), ()),
    ("09 march", "09_multiple_scattering_lut", (), ()),
    ("10 (published table)", "10_sky_view_lut", (PUBLISHED,), ()),
    ("10 of 96x54", "10_sky_view_lut", ("sky_view.size=96x54",), ()),
    ("10 of 192x108", "10_sky_view_lut", (), ()),
    ("10 with every table anew", "10_sky_view_lut", ("tables=all",), ()),
    ("11 with terrain", "11_aerial_perspective", (), None),
    ("11 with every table anew", "11_aerial_perspective", ("tables=all",), None),
    ("07 with 4 paths a pixel", "07_ground_truth", ("samples=4",), ("probe.samples=4",)),
    ("07 with 64 paths a pixel", "07_ground_truth", ("samples=64",), ("probe.samples=64",)),
)


COLUMNS = ("method", "ms", "earth_median", "earth_p95", "alien_median", "alien_p95")


def run(chapter, scene, *arguments, settings=()):
    command = [str(BUILD / "bin" / chapter), "--headless", "--scene", scene, *map(str, arguments)]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"accuracy: {' '.join(command)}\n{done.stderr}")


def table(path):
    return list(csv.DictReader(line for line in open(path, encoding="utf-8") if not line.startswith("#")))


def truth(file):
    """(ray as text, channel, radiance) of the rows that count."""
    rows = []
    for row in table(ROOT / "tests" / "data" / file):
        horizon = 180 - math.degrees(math.asin(6360 / (6360 + float(row["h_km"]))))
        if (row["ground_albedo"] == "0.3" and float(row["Linf_se"]) < 0.01 * float(row["Linf"]) and float(row["sun_zenith_deg"]) <= 94
                and abs(float(row["view_zenith_deg"]) - horizon) > 0.5):
            rows.append((",".join(row[k] for k in ("h_km", "view_zenith_deg", "sun_zenith_deg", "rel_azimuth_deg")), row["channel"], float(row["Linf"])))
    return rows


def errors(work, chapter, scene, rows, settings):
    """Relative errors, in order of size."""
    rays = list(dict.fromkeys(ray for ray, _, _ in rows))
    (work / "rays.csv").write_text("altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg\n" + "\n".join(rays) + "\n")
    run(chapter, scene, "--probe", work / "rays.csv", "--probe-out", work / "light.csv",
        settings=(*settings, "mie.phase=cornette_shanks", "ground.albedo=0.3"))
    light = dict(zip(rays, table(work / "light.csv")))
    return sorted(abs(float(light[ray]["radiance_" + channel]) / value - 1) for ray, channel, value in rows)


def measure(work, size):
    earth, alien = truth("multiple_scattering_earth_cs.csv"), truth("multiple_scattering_alien_cs.csv")
    rows, device = [], {}
    for name, chapter, settings, probing in METHODS:
        times = []
        for scene, view in VIEWS:
            run(chapter, scene, "--view", view, "--size", size, "--bench", work / "bench.json", settings=settings)
            bench = json.loads((work / "bench.json").read_text())
            device = {key: bench[key] for key in ("device", "driver", "software")}
            times.append(sum(p["median_ms"] for p in bench["passes"]))
        scores = []
        for scene, truths in (("earth", earth), ("alien", alien)) if probing is not None else ():
            found = errors(work, chapter, scene, truths, (*settings, *probing))
            scores += [found[len(found) // 2], found[int(0.95 * len(found))]]
        numbers = [f"{v:.3g}" for v in (sum(times) / len(times), *scores)]
        rows.append([name, *numbers, *[""] * (len(COLUMNS) - 1 - len(numbers))])
        print(*rows[-1], flush=True)
    facts = {"device": device["device"], "driver": device["driver"], "software driver": "yes" if device["software"] else "no", "resolution": size}
    about = (f"relative error against Monte Carlo on {len(earth)} rows of Earth and {len(alien)} of the dense planet (sun above -4 degrees, more "
             "than 0.5 degrees from the horizon); time of all passes, mean of noon, sunset and the dense planet")
    return about, facts, rows


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".new")
    temporary.write_text(text, encoding="utf-8")
    os.replace(temporary, path)
    print(f"wrote {path.relative_to(ROOT)}")


def draw(path):
    """The chart of a table that measure() made, as SVG."""
    if not shutil.which("gnuplot"):
        sys.exit("accuracy: no gnuplot here")
    facts = dict(re.findall(r"^# ([^:\n]*): (.*)$", path.read_text(encoding="utf-8"), re.M))
    points = [(float(row["ms"]), float(row["earth_p95"]), row["method"]) for row in table(path) if row["earth_p95"]]

    def block(name, data):
        return f"${name} << EOD\n" + "".join(f'{t:.6g} {e:.6g} "{n}"\n' for t, e, n in data) + "EOD\n"

    labels, taken = [], []  # a label that would lie on another one goes below its point, or further up
    for ms, error, name in sorted(points):
        for lines in (0.4, -0.5, 1.3, -1.4):
            place = math.log10(ms), math.log10(error) + 0.11 * lines
            if all(abs(place[0] - x) > 0.8 or abs(place[1] - y) > 0.08 for x, y in taken):
                break
        taken.append(place)
        labels.append(f'set label "{name}" at {ms:.6g},{error:.6g} left offset 0.7,{lines} font ",10" noenhanced\n')

    software = ", software driver" if facts["software driver"] == "yes" else ""
    script = f"""set encoding utf8
set terminal svg size 900,640 font 'sans-serif,13' background '#ffffff'
{block("all", points)}{block("front", pareto(points))}
set title "Every method, Earth\\n{facts['device']} · {facts['driver']}{software} · {facts['resolution']}" noenhanced
set xlabel 'ms per frame, mean of three views'
set ylabel 'relative error of single rays, 95th percentile'
set logscale xy
set grid
set offsets graph 0.05, graph 0.3, graph 0.05, graph 0.05
set key outside bottom center horizontal
{"".join(labels)}plot $all using 1:2 with points pt 7 ps 0.7 lc '#2050a0' title 'methods', $front using 1:2 with lines lw 2 lc '#b03000' title 'Pareto front'
"""
    done = subprocess.run(["gnuplot"], input=script, capture_output=True, text=True, encoding="utf-8")
    if done.returncode != 0 or "</svg>" not in done.stdout:
        sys.exit("accuracy: gnuplot: " + " ".join(done.stderr.split()))
    return re.sub(r"<desc>Produced by GNUPLOT[^<]*</desc>\s*", "", done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="of the files: lavapipe, gpu")
    parser.add_argument("--size", default="1920x1080", help="of the timed frames")
    parser.add_argument("--draw", action="store_true", help="only draw the table that is there")
    options = parser.parse_args()
    target = ROOT / "docs" / "generated" / f"accuracy_{options.name}.csv"
    if not options.draw:
        with tempfile.TemporaryDirectory(prefix="welkin-accuracy-") as directory:
            about, facts, rows = measure(Path(directory), options.size)
        facts["source"] = f"python3 docs/accuracy.py {options.name} --size {options.size}"
        write(target, "".join(f"# {line}\n" for line in (about, *(f"{k}: {v}" for k, v in facts.items()))) +
              "\n".join(",".join(row) for row in (COLUMNS, *rows)) + "\n")
        if not shutil.which("gnuplot"):
            print(f"no gnuplot here: python3 docs/accuracy.py {options.name} --draw where there is")
            return
    elif not target.exists():
        sys.exit(f"accuracy: {target.relative_to(ROOT)} is not there: measure first, without --draw")
    write(ROOT / "docs" / "pictures" / f"accuracy_{options.name}.svg", draw(target))


if __name__ == "__main__":
    main()
