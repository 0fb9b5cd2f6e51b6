#!/usr/bin/env python3
"""Error against time: plot.py SWEEP.csv [OUT.svg] [--time gpu|wall] [--views max|rms]

Draws a sweep's settings on log-log axes with their Pareto front (no setting is both faster and closer) and prints what
a factor of two in time buys on it. Time: median ms per frame, mean over the views. Error: relative RMSE, by default of
the worst view. Python's standard library and gnuplot; the SVG depends on nothing but the CSV.
"""
import argparse
import csv
import math
import os
import re
import subprocess
import sys


class Bad(Exception):
    pass


def read(path):
    """Comment lines 'key: value' as a dict, the columns' names, and the rows as dicts with their numbers converted."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = [(number, line) for number, line in enumerate(file, 1) if line.strip()]
    facts = dict(re.findall(r"^# ?([^:]*): ?(.*?)\s*$", "".join(line for _, line in lines), re.M))
    lines = [(number, line) for number, line in lines if not line.startswith("#")]
    table = list(csv.reader(line for _, line in lines)) or [[]]
    names, rows, numbers = table[0], [], ("gpu_ms_median", "wall_ms", "relative_rmse")
    for need in ("view", *numbers):
        if need not in names:
            raise Bad(f"{path}: column '{need}' is missing: there are {', '.join(names) or 'none'}")
    for (number, _), fields in zip(lines[1:], table[1:]):
        if len(fields) != len(names):
            raise Bad(f"{path}:{number}: {len(fields)} fields where the header has {len(names)}")
        row = dict(zip(names, fields))
        for name in numbers:
            try:
                row[name] = float(row[name])
            except ValueError:
                raise Bad(f"{path}:{number}: {name} '{row[name]}' is not a number") from None
            if not math.isfinite(row[name]):
                raise Bad(f"{path}:{number}: {name} is {row[name]}: this setting gave NaN or infinite values")
        rows.append(row)
    if not rows:
        raise Bad(f"{path}: no rows")
    return facts, names, rows


def settings(names, rows, time_column, views):
    """One (ms, error, text) per setting, over its views; text names the knobs that vary."""
    knobs = [n for n in names if n.startswith("knob:") and len({row[n] for row in rows}) > 1]
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[n] for n in knobs), []).append(row)
    if len({len(group) for group in groups.values()}) > 1:
        raise Bad("not every setting was measured on every view: the sweep is incomplete")
    points = []
    for key, group in groups.items():
        errors = [row["relative_rmse"] for row in group]
        error = max(errors) if views == "max" else math.sqrt(sum(e * e for e in errors) / len(errors))
        text = " ".join(f"{n[5:]}={v}" for n, v in zip(knobs, key))
        points.append((sum(row[time_column] for row in group) / len(group), error, text))
    return points


def pareto(points):
    """Fastest first; each next one is slower and closer."""
    front = []
    for point in sorted(points):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return front


def error_at(front, ms):
    """The front's error at a time, straight between points on log-log axes."""
    for (t0, e0, _), (t1, e1, _) in zip(front, front[1:]):
        if t0 <= ms <= t1:
            return e0 * (e1 / e0) ** (math.log(ms / t0) / math.log(t1 / t0))
    return front[-1][1]


def sentence(front):
    fast, slow = front[0][0], front[-1][0]
    if slow < 2 * fast:
        return f"The front spans less than a factor of two in time ({fast:.3g} to {slow:.3g} ms)."
    whole = (front[0][1] / front[-1][1]) ** (math.log(2) / math.log(slow / fast))
    cheap, dear = front[0][1] / error_at(front, 2 * fast), error_at(front, slow / 2) / front[-1][1]
    return (f"A factor of two in time buys {whole:.2g} times less error on average from {fast:.3g} to {slow:.3g} ms "
            f"({cheap:.2g} times at the cheap end, {dear:.2g} times at the dear end).")


def draw(points, front, facts, axis):
    def block(name, rows):
        return f"${name} << EOD\n" + "".join(f"{t:.9g} {e:.9g}\n" for t, e, _ in rows) + "EOD\n"

    def quoted(text):  # gnuplot runs what stands in backquotes
        return '"' + re.sub(r'[^ -~·×]|["\\`]', " ", text) + '"'

    where = [facts.get(key, "?") for key in ("device", "driver", "resolution")]
    where += ["software driver"] * (facts.get("software driver") == "yes")
    title = f"{facts.get('chapter', '')} · {facts.get('scene', '')}: error against time"
    labels = "".join(f"set label {quoted(text)} at {t:.9g},{e:.9g} font ',10' noenhanced "
                     f"{'right offset 0,-0.9' if t > front[0][0] else 'left offset 0,0.8'}\n"
                     for t, e, text in sorted({front[0], front[len(front) // 2], front[-1]}))
    times, errors = [p[0] for p in points], [p[1] for p in points]
    # gnuplot labels powers of ten only, and a ladder may span less than one: 1, 2, 5 of each decade.
    decades = range(math.floor(math.log10(min(times))) - 1, math.ceil(math.log10(max(times))) + 2)
    tics = ", ".join(f"'{m * 10.0 ** d:g}' {m * 10.0 ** d:g}" for d in decades for m in (1, 2, 5))
    script = f"""set encoding utf8
set terminal svg size 900,600 font 'sans-serif,14' background '#ffffff'
{block("all", points)}{block("front", front)}{labels}
set title {quoted(title)}."\\n".{quoted(" · ".join(where))} noenhanced
set xlabel {quoted(axis[0])}
set ylabel {quoted(axis[1])}
set logscale xy
set grid
set xrange [{min(times) / 1.3:.9g}:{max(times) * 2.5:.9g}]
set yrange [{min(errors) / 2:.9g}:{max(errors) * 2:.9g}]
set format y '%.0e'
set xtics ({tics})
set key outside bottom center horizontal
plot $all with points pt 7 ps 0.5 lc '#8a8a8a' title 'every setting', \\
  $front with linespoints pt 7 ps 0.8 lw 2 lc '#b03000' title 'Pareto front'
"""
    done = subprocess.run(["gnuplot"], input=script, capture_output=True, text=True, encoding="utf-8")
    if done.returncode != 0 or "</svg>" not in done.stdout:
        raise Bad("gnuplot: " + (" ".join(done.stderr.split()) or "no output"))
    return re.sub(r"<desc>Produced by GNUPLOT[^<]*</desc>\s*", "", done.stdout)


def main():
    parser = argparse.ArgumentParser(prog="plot", description=__doc__.split("\n\n")[1])
    parser.add_argument("csv", help="written by --sweep")
    parser.add_argument("svg", nargs="?", help="default: beside the CSV")
    parser.add_argument("--time", choices=("gpu", "wall"), default="gpu")
    parser.add_argument("--views", choices=("max", "rms"), default="max")
    options = parser.parse_args()
    facts, names, rows = read(options.csv)
    points = settings(names, rows, {"gpu": "gpu_ms_median", "wall": "wall_ms"}[options.time], options.views)
    shown = [p for p in points if p[0] > 0 and p[1] > 0]
    if not shown:
        raise Bad(f"{options.csv}: no setting with a time and an error above zero")
    if len(shown) < len(points):
        print(f"{len(points) - len(shown)} settings with no time or no error cannot stand on log axes: left out")
    count = len({row["view"] for row in rows})
    axis = (f"{options.time} time, ms per frame (mean of {count} views)",
            f"relative RMSE ({options.views} of {count} views)")
    front, out = pareto(shown), options.svg or os.path.splitext(options.csv)[0] + ".svg"
    svg, temporary = draw(shown, front, facts, axis), f"{out}.{os.getpid()}.tmp"
    try:
        with open(temporary, "x", encoding="utf-8") as file:
            file.write(svg)
        os.replace(temporary, out)
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)
    print(f"{out}: {len(shown)} settings, {len(front)} on the Pareto front\n{sentence(front)}")


if __name__ == "__main__":
    try:
        main()
    except (Bad, OSError, UnicodeDecodeError, csv.Error) as error:
        reason = f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and error.filename else error
        print(f"plot: {reason}", file=sys.stderr)
        sys.exit(2)
