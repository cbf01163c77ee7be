# Discs on a line, event by event, as small multiples: methods down, events across. Columns: x radius speed touched
# (1 for the two that have just collided, 0 otherwise). Arrows point where a disc goes; all is drawn to the scale of x.

panel_width = 236; panel_height = 118; left_edge = 92; right_edge = 14; top_edge = 40; bottom_edge = 10; gap = 10
width = left_edge + right_edge + columns_count * panel_width + (columns_count - 1) * gap
height = top_edge + bottom_edge + rows_count * (panel_height + gap) - gap
eval paper(width, height)

stats 'data' using ($1 - $2) name 'low' nooutput
stats 'data' using ($1 + $2) name 'high' nooutput
reach = (abs(low_min) > abs(high_max) ? abs(low_min) : abs(high_max)) + 0.4
set xrange [-reach:reach]
set yrange [-reach * panel_height / panel_width * 1.0:reach * panel_height / panel_width * 1.0]
unset tics; unset grid; unset key
set border 15 linewidth 0.7 linecolor rgb faint
set multiplot
do for [r = 1:rows_count] { do for [c = 1:columns_count] {
	panel_left = left_edge + (c - 1) * (panel_width + gap)
	panel_top = height - top_edge - (r - 1) * (panel_height + gap)
	set lmargin at screen 1.0 * panel_left / width
	set rmargin at screen 1.0 * (panel_left + panel_width) / width
	set tmargin at screen 1.0 * panel_top / height
	set bmargin at screen 1.0 * (panel_top - panel_height) / height
	unset label
	if (r == 1) { set label 1 columns[c] at graph 0.5, graph 1 offset 0, 0.8 center textcolor rgb ink }
	if (c == 1) { set label 2 rows[r] at graph 0, graph 0.5 offset -1, 0 right textcolor rgb ink }
	here = 0
	do for [i = 1:series_count] { if (row[i] == r && column[i] == c) { here = i } }
	at = here > 0 ? here - 1 : 0
	if (here > 0) { set label 3 note[here] at graph 0.5, graph 0.9 center textcolor rgb ink }
	plot for [k = 1:(here > 0)] 'data' index at using 1:(-0.1):2 with circles \
			fillstyle solid 0.25 border rgb blue linecolor rgb blue linewidth 1, \
		for [k = 1:(here > 0)] 'data' index at using 1:($4 > 0 ? -0.1 : NaN):2 with circles \
			fillstyle solid 0.3 border rgb orange linecolor rgb orange linewidth 2, \
		for [k = 1:(here > 0)] 'data' index at using 1:(-0.1):3:(0) with vectors head size 0.09, 25 filled \
			linecolor rgb ink linewidth 1.6, \
		NaN notitle
} }
unset multiplot
