# SPDX-License-Identifier: Apache-2.0
# Draws the tables that bench_shading --out leaves in `folder` as PNG.
set datafile separator "\t"
set terminal pngcairo size 1200,460 font "DejaVu Sans,10" background "#ffffff"
set key autotitle columnhead noenhanced samplen 2
set style line 1 lc rgb "#000000" lw 3
set style line 2 lc rgb "#9a9a9a" lw 1.5 dt 2
set style line 3 lc rgb "#c8553d" lw 1.5
set style line 4 lc rgb "#e0a030" lw 1.5
set style line 5 lc rgb "#2a6f97" lw 2
set style line 6 lc rgb "#2a9d5c" lw 2
set grid lc rgb "#e4e4e4"
set border 3 lc rgb "#808080"
set tics nomirror

set output folder."/profiles.png"
set multiplot layout 1,3 margins 0.05,0.985,0.13,0.9 spacing 0.05
set xrange [0:180]
set yrange [0:1]
set xtics 30
set xlabel "angle from the light, degrees"
do for [r in "8 2 0.5"] {
    set title "sphere, R / l = ".r
    plot folder."/sphere_profiles.tsv" \
           using ($1 == real(r) ? $2 : NaN):4 with lines ls 2 title "Lambert", \
        "" using ($1 == real(r) ? $2 : NaN):5 with lines ls 4 title "Gaussian as published", \
        "" using ($1 == real(r) ? $2 : NaN):6 with lines ls 3 title "Gaussian, normalised", \
        "" using ($1 == real(r) ? $2 : NaN):8 with lines ls 5 title "Poisson", \
        "" using ($1 == real(r) ? $2 : NaN):3 with lines ls 1 dt 3 title "random walk"
}
unset multiplot

set output folder."/errors.png"
set multiplot layout 1,2 margins 0.06,0.985,0.13,0.9 spacing 0.08
set logscale xy
set key bottom right
set xrange [0.4:70]
set yrange [0.0001:0.4]
set xtics (0.5, 1, 2, 4, 8, 20, 60)
set format y "%g"
set xlabel "R / l"
set title "sphere: RMS error of the best fit of each kernel"
plot folder."/sphere_errors.tsv" \
       using 1:2 with linespoints ls 2 pt 7 ps 0.6 title "Lambert", \
    "" using 1:3 with linespoints ls 4 pt 7 ps 0.6 title "Gaussian as published", \
    "" using 1:4 with linespoints ls 3 pt 7 ps 0.6 title "Gaussian, normalised", \
    "" using 1:6 with linespoints ls 5 pt 7 ps 0.6 title "Poisson"
set xrange [0.04:1.2]
set yrange [0.004:0.4]
set xtics (0.05, 0.1, 0.25, 0.5, 1)
set xlabel "l / R,  R = 3 V / S"
set title "nine shapes as meshes: mean RMS error in the program"
plot folder."/nine_means.tsv" \
       using 1:2 with linespoints ls 2 pt 7 ps 0.6 title "Lambert", \
    "" using 1:3 with linespoints ls 3 pt 7 ps 0.6 title "probe", \
    "" using 1:4 with linespoints ls 6 pt 7 ps 0.6 title "depth"
unset multiplot
