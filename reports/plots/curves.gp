# Curves and points with error bars. Columns: x y low high.

eval paper(860, 480)
set xlabel x_label
set ylabel y_label
set lmargin 11
stats 'data' using (visible(x_log, $1)) name 'across' nooutput
if (!x_given) { eval roomy('x', x_log, across_min, across_max) }

dash(i) = (i - 1) % 4 + 1
mark(i) = 2 * ((i - 1) % 4) + 5
lines = ''; points = ''
do for [i = 1:series_count] { if (style[i] eq 'points') { points = points.' '.i } else { lines = lines.' '.i } }
plot for [i = 1:series_count] 'data' index i - 1 using 1:3:(0):($4 - $3) with vectors nohead \
		linecolor rgb colour(i) linewidth 1.2 notitle, \
	for [k = 1:words(lines)] 'data' index nth(lines, k) - 1 using 1:2 with lines linecolor rgb colour(nth(lines, k)) \
		linewidth 1.8 dashtype dash(nth(lines, k)) title series[nth(lines, k)], \
	for [k = 1:words(points)] 'data' index nth(points, k) - 1 using 1:2 with points \
		linecolor rgb colour(nth(points, k)) pointtype mark(nth(points, k)) pointsize 0.6 title series[nth(points, k)]
