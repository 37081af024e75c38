# Draws stability.svg from stability.tsv: run in this folder, `gnuplot stability.gnuplot`.
set terminal svg size 920,430 font "DejaVu Sans,12" background "white"
set output "stability.svg"
set multiplot layout 1,2
set logscale xy
set format x "10^{%T}"
set yrange [0.0018:0.22]
set ytics (0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16)
set xlabel "k (kT/a_0^2)"
set ylabel "time step dt (t_0)"
set palette defined (0 "#fff3bf", 0.35 "#e6a532", 0.7 "#a8326e", 1 "#2d0b59")
set cbrange [0:100]
set cbtics ("0" 0, "25" 25, "50" 50, "75" 75, "≥ 100" 100)
set key above
set title "springs (dumbbells, M = 5): energy off by (%)"
set xrange [5:200000]
off(ratio) = abs(ratio - 1.0) * 100.0
plot "stability.tsv" index 0 using 2:3:(off($6)) with points pt 7 ps 1.5 palette notitle, \
     "" index 0 using 2:(stringcolumn(9) eq "fault" ? NaN : $3) with points pt 6 ps 1.5 lc rgb "#555555" notitle, \
     "" index 0 using 2:(stringcolumn(9) eq "fault" ? $3 : NaN) with points pt 2 ps 1.1 lc rgb "black" title "fault", \
     2.0 / sqrt(2.0 * x / 5.0) with lines lw 2 lc rgb "#222222" title "ω dt = 2: refused above"
set title "bends (8 vertices, k = 100, M = 5): energy off by (%)"
set xlabel "bending κ (kT)"
set xrange [0.5:20000]
plot "stability.tsv" index 1 using 2:3:(off($6)) with points pt 7 ps 1.5 palette notitle, \
     "" index 1 using 2:(stringcolumn(9) eq "fault" ? NaN : $3) with points pt 6 ps 1.5 lc rgb "#555555" notitle, \
     "" index 1 using 2:(stringcolumn(9) eq "fault" ? $3 : NaN) with points pt 2 ps 1.1 lc rgb "black" title "fault", \
     "" index 1 using 2:5 with lines lw 2 lc rgb "#222222" title "ω dt = 2: refused above"
unset multiplot
