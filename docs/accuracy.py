#!/usr/bin/env python3
"""Every method of the book on one chart: error against Monte Carlo, time per frame.

accuracy.py NAME [--size 1920x1080]     writes docs/generated/accuracy_NAME.csv and docs/pictures/accuracy_NAME.svg

Errors: each chapter's --probe for the rays of tests/data/multiple_scattering_*.csv (all orders, Cornette-Shanks, ground
albedo 0.3), rows known to 1 %, the sun above -4 degrees and the ray more than 0.5 degrees from the horizon. Times: --bench
at --size, mean of three views. Needs the built chapters (WELKIN_BUILD) and gnuplot. Python's standard library only.
"""
import argparse
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from plot import pareto

ROOT = Path(__file__).resolve().parents[1]
BUILD = Path(os.environ.get("WELKIN_BUILD", ROOT / "build"))
VIEWS = (("noon", "horizon"), ("sunset", "sun"), ("alien", "horizon"))
PUBLISHED = "multiple_scattering.method=published"
METHODS = (  # name, chapter, settings, settings of --probe alone
    ("05 one order", "05_single_scattering", (), ()),
    ("08 one order (table)", "08_transmittance_lut", (), ()),
    ("09 march (published table)", "09_multiple_scattering_lut", (PUBLISHED,), ()),
    ("09 march", "09_multiple_scattering_lut", (), ()),
    ("10 (published table)", "10_sky_view_lut", (PUBLISHED,), ()),
    ("10 of 96x54", "10_sky_view_lut", ("sky_view.size=96x54",), ()),
    ("10 of 192x108", "10_sky_view_lut", (), ()),
    ("10 with every table anew", "10_sky_view_lut", ("tables=all",), ()),
    ("07 with 4 paths a pixel", "07_ground_truth", ("samples=4",), ("probe.samples=4",)),
    ("07 with 64 paths a pixel", "07_ground_truth", ("samples=64",), ("probe.samples=64",)),
)


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
        for scene, truths in (("earth", earth), ("alien", alien)):
            found = errors(work, chapter, scene, truths, (*settings, *probing))
            scores += [found[len(found) // 2], found[int(0.95 * len(found))]]
        rows.append([name, sum(times) / len(times), *scores])
        print(" ".join(f"{v:.3g}" if isinstance(v, float) else v for v in rows[-1]), flush=True)
    return rows, device, (len(earth), len(alien))


def draw(rows, device, size):
    points = [(row[1], row[3], row[0]) for row in rows]
    def block(name, data):
        return f"${name} << EOD\n" + "".join(f'{t:.6g} {e:.6g} "{n}"\n' for t, e, n in data) + "EOD\n"
    software = ", software driver" if device["software"] else ""
    script = f"""set encoding utf8
set terminal svg size 900,640 font 'sans-serif,13' background '#ffffff'
{block("all", points)}{block("front", pareto(points))}
set title "Every method so far, Earth\\n{device['device']} · {device['driver']}{software} · {size}" noenhanced
set xlabel 'ms per frame, mean of three views'
set ylabel 'relative error of single rays, 95th percentile'
set logscale xy
set grid
set offsets graph 0.05, graph 0.3, graph 0.05, graph 0.05
set key outside bottom center horizontal
plot $all using 1:2 with points pt 7 ps 0.7 lc '#2050a0' title 'methods', $front using 1:2 with lines lw 2 lc '#b03000' title 'Pareto front', \\
  $all using 1:2:3 with labels left offset 0.7,0.4 font ',10' noenhanced notitle
"""
    done = subprocess.run(["gnuplot"], input=script, capture_output=True, text=True, encoding="utf-8")
    if done.returncode != 0 or "</svg>" not in done.stdout:
        sys.exit("accuracy: gnuplot: " + " ".join(done.stderr.split()))
    return re.sub(r"<desc>Produced by GNUPLOT[^<]*</desc>\s*", "", done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", help="of the files: lavapipe, gpu")
    parser.add_argument("--size", default="1920x1080", help="of the timed frames")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="welkin-accuracy-") as directory:
        rows, device, counts = measure(Path(directory), options.size)
    lines = [f"# relative error against Monte Carlo on {counts[0]} rows of Earth and {counts[1]} of the dense planet (sun above -4 degrees, more than 0.5 degrees from the horizon); time of all passes, mean of noon, sunset and the dense planet",
             f"# device: {device['device']}", f"# driver: {device['driver']}", f"# software driver: {'yes' if device['software'] else 'no'}",
             f"# resolution: {options.size}", f"# source: python3 docs/accuracy.py {options.name} --size {options.size}"]
    header = ["method", "ms", "earth_median", "earth_p95", "alien_median", "alien_p95"]
    target = ROOT / "docs" / "generated" / f"accuracy_{options.name}.csv"
    for path, text in ((target, "\n".join(lines) + "\n" + ",".join(header) + "\n" + "".join(f'{row[0]},' + ",".join(f"{v:.3g}" for v in row[1:]) + "\n" for row in rows)),
                       (ROOT / "docs" / "pictures" / f"accuracy_{options.name}.svg", draw(rows, device, options.size))):
        temporary = path.with_name(path.name + ".new")
        temporary.write_text(text, encoding="utf-8")
        os.replace(temporary, path)
        print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
