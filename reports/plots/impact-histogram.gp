# Separations at impact, one bar per floating-point number, as small multiples. Columns: left right height.
# The bars show the numbers as the working arithmetic holds them; a bar is as wide as the reals its number stands for.

panel_width = columns_count > 2 ? 270 : columns_count == 2 ? 400 : 700
panel_height = columns_count > 2 ? 170 : columns_count == 2 ? 240 : 340
left_edge = 72; right_edge = 26; top_edge = 74; bottom_edge = 58; gap = 34
width = left_edge + right_edge + columns_count * panel_width + (columns_count - 1) * gap
height = top_edge + bottom_edge + rows_count * (panel_height + 16) - 16
eval paper(width, height)

# Both axes are counted in a power of ten that suits the widest bars.
stats 'data' using 1 name 'low' nooutput
stats 'data' using 2 name 'high' nooutput
stats 'data' using ($3 > 0 ? $3 : NaN) name 'dense' nooutput
reach = abs(low_min) > abs(high_max) ? abs(low_min) : abs(high_max)
power = reach > 0 ? floor(log10(reach)) : 0
power = power > -3 && power < 3 ? 0 : power
unit = 10.0**power
scaled = power == 0 ? '' : sprintf(' [%s]', superscript(power))
per = power == 0 ? '' : sprintf(' per %s', superscript(power))

unset xrange; unset yrange
unset logscale y; set format y '%g'
if (x_given) { set xrange [x_low / unit:x_high / unit] } else { set xrange [low_min / unit:high_max / unit] }
bottom = y_log ? 10.0**floor(log10(dense_min * unit)) : 0
eval log_axis('y', y_log)
set yrange [bottom:dense_max * unit * (y_log ? 30 : 1.42)]

set multiplot
unset key
set label 1 x_label.scaled at screen 0.5, screen (16.0 / height) center textcolor rgb ink
set label 2 y_label.per at screen (16.0 / width), screen 0.5 center rotate by 90 textcolor rgb ink
set arrow 1 from first 0, graph 0 to first 0, graph (y_log ? 1 : 0.72) nohead back linecolor rgb soft linewidth 1.2 dashtype 2
do for [r = 1:rows_count] { do for [c = 1:columns_count] {
	panel_left = left_edge + (c - 1) * (panel_width + gap)
	panel_top = height - top_edge - (r - 1) * (panel_height + 16)
	set lmargin at screen 1.0 * panel_left / width
	set rmargin at screen 1.0 * (panel_left + panel_width) / width
	set tmargin at screen 1.0 * panel_top / height
	set bmargin at screen 1.0 * (panel_top - panel_height) / height
	if (r > 1 || c > 1) { unset label 1; unset label 2 }
	unset label 3
	if (r == 1) { set label 3 columns[c] at graph 0.5, graph 1 offset 0, 0.8 center textcolor rgb ink }
	if (r < rows_count) { set format x '' } else { set format x '%g' }
	if (c > 1) { set format y '' }
	if (c == 1) { set format y '%g'; eval log_axis('y', y_log) }
	remark = ''; bars = ''; lines = ''
	do for [i = 1:series_count] { if (row[i] == r && column[i] == c) {
		if (strlen(remark) == 0) { remark = note[i] }
		if (style[i] eq 'bars') { bars = bars.' '.i } else { lines = lines.' '.i }
	} }
	set label 4 rows[r] at graph 0.02, graph 0.93 left textcolor rgb ink
	set label 5 remark at graph 0.02, graph 0.93 left offset 0, -1.3 textcolor rgb quiet
	if (r == 1 && c == 1) { set key at screen 1.0 * left_edge / width, screen (height - 8.0) / height left top vertical }
	plot for [k = 1:words(bars)] 'data' index nth(bars, k) - 1 \
			using (($1 + $2) / 2 / unit):($3 * unit):($1 / unit):($2 / unit):(bottom):($3 * unit) \
			with boxxyerror fillstyle solid 0.35 border rgb blue linecolor rgb blue linewidth 0.8 title series[nth(bars, k)], \
		for [k = 1:words(lines)] 'data' index nth(lines, k) - 1 using ($1 / unit):($3 * unit):(($2 - $1) / unit):(0) \
			with vectors nohead linecolor rgb orange linewidth 1.8 title series[nth(lines, k)], \
		NaN notitle
	unset key
} }
unset multiplot
