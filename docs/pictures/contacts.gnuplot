# Draws contacts.svg from contacts.tsv: run in this folder, `gnuplot contacts.gnuplot`.
set terminal svg size 920,480 font "DejaVu Sans,12" background "white"
set output "contacts.svg"
set multiplot layout 1,2
set logscale x
set xlabel "time step dt (t_0)" offset 0,0.2
set xrange [0.0042:0.024]
set xtics (0.005, 0.01, 0.02)
set key outside bottom center samplen 2 font ",11" vertical maxrows 4
set bmargin 8
set logscale y
set format y "10^{%T}"
set yrange [1e-11:1]
set title "heat of a contact (kT)"
plot "contacts.tsv" index 0 using 1:2:3 with yerrorbars pt 7 ps 0.7 lc rgb "#882255" title "sequential, stay", \
     "" index 1 using 1:2:3 with yerrorbars pt 6 ps 0.7 lc rgb "#882255" title "sequential, bounce", \
     462.0 * x**2 with lines dt 2 lc rgb "#882255" title "∝ dt^2", \
     "" index 2 using 1:4:5 with yerrorbars pt 7 ps 0.7 lc rgb "#00775a" title "event-driven, κ 64", \
     "" index 3 using 1:4:5 with yerrorbars pt 6 ps 0.7 lc rgb "#00775a" title "κ 16", \
     "" index 4 using 1:4:5 with yerrorbars pt 5 ps 0.7 lc rgb "#2f86c5" title "needles", \
     3.3e3 * x**4 with lines dt 2 lc rgb "#00775a" title "∝ dt^4 (each kind its own)", \
     1.5e2 * x**4 with lines dt 2 lc rgb "#00775a" notitle, \
     6.4e-2 * x**4 with lines dt 2 lc rgb "#2f86c5" notitle
unset logscale y
set format y "%g"
set yrange [0.994:1.004]
set title "balance, κ 64: ⟨J exp(−ΔH/kT)⟩"
plot "contacts.tsv" index 2 using (0.985*$1):6:7 with yerrorbars pt 7 ps 0.7 lc rgb "#00775a" title "J = (a'/a) |da'/da|", \
     "" index 2 using (1.015*$1):8:9 with yerrorbars pt 6 ps 0.7 lc rgb "#b35900" title "J = a'/a also where softened", \
     1.0 with lines lc rgb "#222222" title "exact"
unset multiplot
