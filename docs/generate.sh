#!/usr/bin/env bash
# Makes anew what of docs/generated takes minutes and no GPU, from the built programs and the measured tables that are there:
# the table of options, knobs, explanations, the mutants of chapter 05, curves and their sentences. Then: docs/weave.py.
# What is measured anew and when is said on the pages; WELKIN_BUILD as for the tests.
set -euo pipefail
cd "$(dirname "$(readlink -f -- "${BASH_SOURCE[0]}")")/.."
build=$(realpath -m -- "${WELKIN_BUILD:-build}") out=docs/generated
unset DISPLAY WAYLAND_DISPLAY
program() { local found=("$build/bin/$1"_*) && printf '%s' "${found[0]}"; }  # of a chapter's number

COLUMNS=120 "$(program 05)" --help >$out/options.txt
for table in "$out"/knobs_*.json; do
  number=${table##*_} && "$(program "${number%.json}")" --dump knobs "$table"
done
explain() { "$(program "$1")" --explain --scene noon --size 320x180 --frames 5 | sed -n '/^effects:$/,/^declared:$/p' | sed '$d'; }
explain 08 >$out/08_explain.txt  # which effects are on, how often each pass ran, which barriers there were
"$(program 17)" --explain --scene fair --size 320x180 --frames 5 | sed -n '/^effects:$/,/^declared:$/p' | sed '$d' >$out/17_explain.txt
for number in 09 10 11; do explain $number | grep -v '^  before' >$out/${number}_explain.txt; done
WELKIN_BUILD=$build python3 tests/hard/mutants.py 05 --write $out/mutants.txt >/dev/null
for table in 09_sweep_gpu 10_sweep_gpu 11_sweep_gpu; do
  python3 docs/plot.py $out/$table.csv docs/pictures/$table.svg
done
python3 docs/plot.py $out/16_sweep.csv docs/pictures/16_sweep.svg | tail -n 1 >$out/16_factor_of_two.txt
# Chapter 16: where its textures come from at a first start, and at the next one.
cache=$(mktemp -d)
start() {
  WELKIN_CACHE=$cache "$(program 16)" --headless --size 320x180 --frames 1 --explain --output "$cache/picture.png" |
    sed -nE '/^(noise (base|curl|detail)|weather|alligator): /{s|/[^ ]*/[a-z_]*_[0-9a-f]*\.bin|the cache|;s/; kept in the cache/, kept/;p}'
}
{ echo cold && start && echo warm && start; } >$out/16_start.txt
"$(program 16)" --headless --size 32x18 --frames 1 --output "$cache/picture.png" | sed -n '1s/.* · //p' >>$out/16_start.txt
rm -r "$cache"
for table in 10_sweep_gpu 11_sweep_gpu 17_sweep_gpu; do
  python3 docs/plot.py $out/$table.csv docs/pictures/$table.svg | tail -n 1 >$out/"${table/sweep_gpu/factor_of_two_gpu}".txt
done
python3 - <<'PYTHON' >$out/11_tables.txt
import json
bench = json.load(open("docs/generated/11_bench_gpu_all.json"))
times = {row["name"]: 1000 * row["median_ms"] for row in bench["passes"]}
parts = [(name, times[name]) for name in ("transmittance", "multiple scattering", "sky view", "aerial perspective")]
total = sum(time for _, time in parts)
verdict = "met" if total <= 150 else "missed"
print(" + ".join(f"{name} {time:.1f}" for name, time in parts) + f" = {total:.0f} µs: the target of 150 is {verdict} ({bench['device']}, {bench['driver']})")
PYTHON
