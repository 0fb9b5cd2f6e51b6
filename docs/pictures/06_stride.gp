# gnuplot 06_stride.gp, run in docs/pictures: error of the exposure against the time of the histogram, from docs/generated/06_stride*.csv.
set terminal svg size 900,460 font "sans-serif,14" background "white"
set output "06_stride.svg"
set datafile separator ","
set datafile commentschars "#"
set logscale xy
set grid
set key top right
set xlabel "histogram of 1920 x 1080, ms"
set ylabel "worst error of the exposure, stops"
plot "../generated/06_stride.csv" using 3:($1 > 1 ? $6 : 1/0) skip 1 with linespoints lw 2 pt 7 ps 0.6 lc "#1f6fb4" title "software driver; from the right: stride 2, 4, 8, 16"
