# gnuplot 06_curves.gp, run in docs/pictures: the tone curves, from docs/generated/06_curves.csv.
set terminal svg size 900,520 font "sans-serif,14" background "white"
set output "06_curves.svg"
set datafile separator ","
set datafile commentschars "#"
set xrange [-6:6]
set yrange [0:1.02]
set xtics 1
set grid
set key top left
set xlabel "light, stops from middle grey"
set ylabel "what the screen is sent, 0 to 1"
srgb(x) = x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055
file = "../generated/06_curves.csv"
plot file using 1:(srgb($2)) skip 1 with lines lw 1.5 lc "#888888" title "clamp", \
     file using 1:(srgb($3)) skip 1 with lines lw 2 lc "#1f6fb4" title "Reinhard, white at 4", \
     file using 1:(srgb($4)) skip 1 with lines lw 2 lc "#d08010" title "ACES, Narkowicz", \
     file using 1:(srgb($5)) skip 1 with lines lw 2 lc "#208040" title "ACES, Hill", \
     file using 1:(srgb($6)) skip 1 with lines lw 2 lc "#a03090" title "Lottes", \
     file using 1:(srgb($7)) skip 1 with lines lw 2 lc "#c02020" title "Uchimura", \
     file using 1:(srgb($8)) skip 1 with lines lw 2 lc "#20a0a0" title "Uncharted 2"
