# gnuplot 04_phase.gp, run in docs/pictures: phase functions against the angle, from docs/generated/04_phase.csv.
set terminal svg size 900,520 font "sans-serif,14" background "white"
set output "04_phase.svg"
set datafile separator ","
set logscale y
set format y "10^{%T}"
set xrange [0:180]
set yrange [1e-3:1e3]
set xtics 30
set grid
set key top right
set xlabel "scattering angle, degrees"
set ylabel "phase function, 1/sr"
file = "../generated/04_phase.csv"
set datafile commentschars "#"
plot file using 1:2 skip 1 with lines lw 1.5 dt 2 lc "#888888" title "isotropic", \
     file using 1:3 skip 1 with lines lw 2 lc "#1f6fb4" title "Rayleigh", \
     file using 1:5 skip 1 with lines lw 2 lc "#d08010" title "Henyey-Greenstein, g = 0.8", \
     file using 1:6 skip 1 with lines lw 2 lc "#208040" title "Cornette-Shanks, g = 0.8", \
     file using 1:8 skip 1 with lines lw 2 lc "#a03090" title "double HG, g = 0.8 and -0.3 (10 %)", \
     file using 1:9 skip 1 with lines lw 2 lc "#c02020" title "droplets of 10 um (HG + Draine)"
