# A ball's height over time, and the end of it enlarged on logarithmic axes. Columns: time height remaining (time that
# is left until rest). The first series is drawn broad, so that those that follow it for a while stay visible.

eval paper(1000, 460)
set multiplot layout 1, 2
set tmargin at screen 0.86
set bmargin at screen 0.14
breadth(i) = i == 1 && series_count > 1 ? 4.5 : 1.2
tint(i) = i == 1 && series_count > 1 ? '#9dc0ea' : i == 2 ? ink : colour(i)

# Where a series that stops has its last row, and how high its last arc was.
array last_time[series_count]; array last_remaining[series_count]; array last_arc[series_count]
do for [i = 1:series_count] {
	stats 'data' index i - 1 using (last_time[i] = $1, last_remaining[i] = $3, $1) nooutput
	stats 'data' index i - 1 using ($3 <= 2 * last_remaining[i] ? $2 : NaN) name 'arc' nooutput
	last_arc[i] = arc_max
	if (style[i] ne 'ends') { last_time[i] = NaN; last_remaining[i] = NaN }
}
ended(i) = last_time[i] == last_time[i]

set lmargin at screen 0.075
set rmargin at screen 0.47
set xlabel x_label
set ylabel y_label
set key at screen 0.07, 0.98 left top vertical maxrows 2
set yrange [0:*]
eval given_range('y', y_given, y_low, y_high)
plot for [i = 1:series_count] 'data' index i - 1 using 1:2 with lines linecolor rgb tint(i) linewidth breadth(i) \
		title series[i], \
	for [i = 1:series_count] '+' using (last_time[i]):(0) every ::::0 with points linecolor rgb red \
		pointtype 2 pointsize 1.2 linewidth 2.5 title ended(i) ? 'it ends here' : ''

# The lowest height worth showing: well below the last arcs.
stats 'data' using ($3 > 0 ? $3 : NaN) name 'left' nooutput
stats 'data' using ($3 < 10 * left_min ? $2 : NaN) name 'arcs' nooutput
floor_height = 1e-3 * arcs_max
stats 'data' using ($2 > floor_height && $3 > 0 ? $3 : NaN) name 'shown' nooutput

unset key
set lmargin at screen 0.575
set rmargin at screen 0.97
set xlabel 'time left until rest'
eval log_axis('x', 10)
eval log_axis('y', 10)
unset mxtics; unset mytics
# Labels at even powers of ten, one by one: gnuplot takes no step on a reversed logarithmic axis.
step = ceil((log10(shown_max) - log10(shown_min)) / 6)
set xtics ('' 10 * shown_max)
do for [k = floor(log10(shown_min) / step):floor(log10(shown_max) / step)] {
	set xtics add (superscript(int(k * step)) 10.0**(k * step))
}
set xrange [*:*] reverse
set yrange [floor_height:*]
plot for [i = 1:series_count] 'data' index i - 1 using 3:($2 > floor_height ? $2 : NaN) with lines \
		linecolor rgb tint(i) linewidth breadth(i), \
	for [i = 1:series_count] '+' using (last_remaining[i]):(last_arc[i]) every ::::0 with points linecolor rgb red \
		pointtype 2 pointsize 1.2 linewidth 2.5
unset multiplot
