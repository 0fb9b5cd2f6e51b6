# gnuplot 09_errors.gp, run in docs/pictures: median error per altitude and sun, from docs/generated/09_error_map.csv.
set terminal svg size 900,720 font "sans-serif,13" background "white"
set output "09_errors.svg"
set datafile separator ","
set datafile commentschars "#"
file = "../generated/09_error_map.csv"
set multiplot layout 2,2
set logscale cb
set cbrange [0.1:100]
set cblabel "median error, percent"
set palette defined (0 "#1f6fb4", 0.33 "#7fc8a0", 0.66 "#f0c040", 1 "#c02020")
set logscale y
set yrange [1e-4:1e5]
set format y "10^{%T}"
set xrange [-3:99]
set xlabel "sun zenith, degrees"
set ylabel "altitude, km"
set key off
set grid
clip(x) = x < 0.1 ? 0.1 : x > 100 ? 100 : x
only(name, wanted, x) = name eq wanted ? x : NaN
do for [planet in "earth alien"] {
  set title planet.", published"
  plot file using (only(strcol(1), planet, $3)):2:(clip($5)) skip 1 with points pt 7 ps 1.6 lc palette
  set title planet.", moments"
  plot file using (only(strcol(1), planet, $3)):2:(clip($7)) skip 1 with points pt 7 ps 1.6 lc palette
}
unset multiplot
