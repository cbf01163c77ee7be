# Speed against worth, as small multiples: of all points those that no other beats stand out, joined by the frontier;
# those that are beaten are faint. Columns: x y low high best, and the words to print beside the point. Where y is a
# share on a logarithmic axis, none at all has a lane of its own below the others.

panel_width = columns_count > 1 ? 400 : 700
panel_height = rows_count > 1 ? 300 : 420
left_edge = 82; right_edge = 24; top_edge = columns_count > 1 ? 104 : 28; bottom_edge = 58; gap = 40
width = left_edge + right_edge + columns_count * panel_width + (columns_count - 1) * gap
height = top_edge + bottom_edge + rows_count * (panel_height + gap) - gap
sizing = 'dynamic'
eval paper(width, height)

tints = '#2f6db3 #c8641c #3d8b4f #7f56a8 #2a8c94 #c23b3b #8a6d3b #c0569b #6b7280'
faints = '#b9cee5 #eec9b0 #bed8c4 #d6c8e3 #b7d8da #ebbebe #d8cdbb #e9c6dc #cdd0d5'
marks = '7 5 9 13 11 15 6 4 8'

# The same label has the same tint in every panel.
array shade[series_count]; array head[series_count]
heads = 0
do for [i = 1:series_count] {
	shade[i] = 0; head[i] = 1
	do for [j = 1:i - 1] { if (style[i] eq 'points' && style[j] eq 'points' && series[j] eq series[i]) { shade[i] = shade[j] } }
	if (style[i] eq 'points' && shade[i] == 0) { heads = heads + 1; shade[i] = heads; head[heads] = i }
}
tint(i) = word(tints, (shade[i] + 8) % 9 + 1)
paled(i) = word(faints, (shade[i] + 8) % 9 + 1)
mark(i) = int(word(marks, (shade[i] + 8) % 9 + 1))

# One range for all panels, with air for the words to the right of the last point.
stats 'data' using (visible(x_log, $1)) name 'across' nooutput
stats 'data' using (visible(y_log, $2)) name 'up' nooutput
stats 'data' using ($2 == 0 ? 1 : NaN) name 'none' nooutput
laned = y_log > 0 && exists('none_records') && none_records > 0
lane = y_log > 0 ? 10.0**(floor(log10(up_min)) - 1) : 0
stretch = across_max > across_min ? across_max / across_min : 10.0
left_x = across_min / stretch**0.05; right_x = across_max * stretch**0.25
low_y = y_log ? (laned ? lane / 2 : up_min / 2) : up_min - 0.07 * span(up_min, up_max)
high_y = y_log ? up_max * 2 : up_max + 0.07 * span(up_min, up_max)
if (y_given) { low_y = y_low; high_y = y_high }
shown(y) = laned && y == 0 ? lane : y
set xrange [left_x:right_x]
set yrange [low_y:high_y]
if (laned) { set ytics add ('none' lane) }

# Where the points are, for what answers to the pointer.
panel_left(i) = left_edge + (column[i] - 1) * (panel_width + gap)
panel_top(i) = top_edge + (row[i] - 1) * (panel_height + gap)
part(base, value, low, high) = base ? (log(value) - log(low)) / (log(high) - log(low)) : (value - low) / (high - low)
if (!pdf) {
	set table 'marks'
	do for [i = 1:series_count] {
		plot 'data' index i - 1 using (i - 1):0:(panel_left(i) + panel_width * part(x_log, $1, left_x, right_x)):(panel_top(i) + panel_height * (1 - part(y_log, shown($2), low_y, high_y))) with table
	}
	unset table
}

set multiplot
unset key
set label 1 x_label at screen 0.5, screen (16.0 / height) center textcolor rgb ink
set label 2 y_label at screen (16.0 / width), screen 0.5 center rotate by 90 textcolor rgb ink
do for [r = 1:rows_count] { do for [c = 1:columns_count] {
	from_left = left_edge + (c - 1) * (panel_width + gap)
	from_top = height - top_edge - (r - 1) * (panel_height + gap)
	set lmargin at screen 1.0 * from_left / width
	set rmargin at screen 1.0 * (from_left + panel_width) / width
	set tmargin at screen 1.0 * from_top / height
	set bmargin at screen 1.0 * (from_top - panel_height) / height
	if (r > 1 || c > 1) { unset label 1; unset label 2 }
	heading = rows[r].(strlen(rows[r]) && strlen(columns[c]) ? ', ' : '').columns[c]
	set label 3 heading at graph 0, graph 1 offset 0, 0.8 left textcolor rgb ink
	if (r < rows_count) { set format x '' } else { eval log_axis('x', x_log) }
	lines = ''; points = ''
	do for [i = 1:series_count] { if (row[i] == r && column[i] == c) {
		if (style[i] eq 'points') { points = points.' '.i } else { lines = lines.' '.i }
	} }
	if (r == 1 && c == 1) { set key at screen 1.0 * left_edge / width, screen (height - 6.0) / height left top vertical maxrows 3 }
	plot for [k = 1:words(lines)] 'data' index nth(lines, k) - 1 using 1:(shown($2)) with steps linecolor rgb soft linewidth 1.4 notitle, \
		for [k = 1:words(points)] 'data' index nth(points, k) - 1 using ($5 > 0 ? NaN : $1):(shown($2)) with points \
			linecolor rgb paled(nth(points, k)) pointtype mark(nth(points, k)) pointsize 0.55 notitle, \
		for [k = 1:words(points)] 'data' index nth(points, k) - 1 using 1:3:(0):($4 - $3) with vectors nohead \
			linecolor rgb paled(nth(points, k)) linewidth 1.2 notitle, \
		for [k = 1:words(points)] 'data' index nth(points, k) - 1 using ($5 > 0 ? $1 : NaN):(shown($2)) with points \
			linecolor rgb tint(nth(points, k)) pointtype mark(nth(points, k)) pointsize 0.75 notitle, \
		for [k = 1:words(points)] 'data' index nth(points, k) - 1 using 1:(shown($2)):(stringcolumn(6)) with labels left \
			offset 0.7, -0.55 noenhanced font ',11' textcolor rgb ink notitle, \
		for [h = 1:heads > 1 ? heads : 0] keyentry with points linecolor rgb tint(head[h]) pointtype mark(head[h]) pointsize 0.7 title series[head[h]], \
		NaN notitle
	unset key
} }
unset multiplot
