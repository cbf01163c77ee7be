# Error against significand bits, with fitted lines. Columns: bits error.

eval paper(860, 480)
set xlabel x_label
set ylabel y_label
set lmargin 11
set autoscale # a range that is given would hide from the next line what lies outside it
stats 'data' using 1 name 'across' nooutput
stats 'data' using (visible(y_log, $2)) name 'up' nooutput
eval given_range('x', x_given, x_low, x_high)
eval given_range('y', y_given, y_low, y_high)
if (!x_given) { eval roomy('x', x_log, across_min, across_max) }
if (!y_given) { eval roomy('y', y_log, up_min, up_max) }

base = y_log > 0 ? y_log : 10
mark(i) = 2 * ((i - 1) % 4) + 5
fitted(i, x) = base**(intercept[i] + slope[i] * x)
has_fit(i) = slope[i] == slope[i]
told(i) = has_fit(i) ? sprintf('%s, slope %s%.3f', series[i], slope[i] < 0 ? '−' : '', abs(slope[i])) : series[i]
plot for [i = 1:series_count] 'data' index i - 1 using 1:(has_fit(i) ? fitted(i, $1) : NaN) with lines \
		linecolor rgb colour(i) linewidth 1.2 dashtype 2 notitle, \
	for [i = 1:series_count] 'data' index i - 1 using 1:2 with points linecolor rgb colour(i) \
		pointtype mark(i) pointsize 0.7 title told(i)
