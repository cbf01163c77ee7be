# A value over a plane, one cell a point, on a logarithmic scale of colours; cells without a value are left white. What is
# printed in a cell is the word of its point. Columns: x y value.

width = 860; height = 480; left_edge = 82; right_edge = 96; top_edge = 14; bottom_edge = 58
eval paper(width, height)
unset grid
unset key
set xlabel x_label
set ylabel y_label
set border 15 linewidth 1 linecolor rgb soft
set lmargin at screen 1.0 * left_edge / width
set rmargin at screen 1 - 1.0 * right_edge / width
set tmargin at screen 1 - 1.0 * top_edge / height
set bmargin at screen 1.0 * bottom_edge / height

power(value) = value > 0 ? log10(value) : NaN
stats 'data' using (power($3)) name 'value' nooutput
least = exists('value_min') ? floor(value_min) : -1
most = exists('value_max') ? ceil(value_max) : 0

# Cells are as large as the distance of two neighbours, so that they fill the plane.
stats 'data' using 1 name 'across' nooutput
stats 'data' using 2 name 'up' nooutput
seen_x = ' '; seen_y = ' '; across = 0; upwards = 0
told(x) = sprintf('%.9g ', x)
do for [k = 0:across_records - 1] {
	stats 'data' using 1:2 every ::k::k name 'one' nooutput
	if (strstrt(seen_x, ' '.told(one_min_x)) == 0) { seen_x = seen_x.told(one_min_x); across = across + 1 }
	if (strstrt(seen_y, ' '.told(one_min_y)) == 0) { seen_y = seen_y.told(one_min_y); upwards = upwards + 1 }
}
pitch(low, high, number) = number > 1 ? (high - low) / (number - 1) : 1.0
wide = pitch(across_min, across_max, across); high = pitch(up_min, up_max, upwards)
left_x = across_min - wide / 2; right_x = across_max + wide / 2
low_y = up_min - high / 2; high_y = up_max + high / 2
set xrange [left_x:right_x]
set yrange [low_y:high_y]

# Where the points are, for what answers to the pointer.
if (!pdf) {
	set table 'marks'
	plot 'data' using (0):0:(left_edge + (width - left_edge - right_edge) * ($1 - left_x) / (right_x - left_x)):(top_edge + (height - top_edge - bottom_edge) * (high_y - $2) / (high_y - low_y)) with table
	unset table
}

set cbrange [least:most > least ? most : least + 1]
set palette defined (0 '#edf3fa', 0.35 '#a9c8e8', 0.65 '#efc79a', 1 '#d8694f')
set format cb '10^{%.0f}'
set cbtics 1
set colorbox user origin screen 1 - 74.0 / width, screen 1.0 * bottom_edge / height \
	size screen 16.0 / width, screen (height - top_edge - bottom_edge) / (1.0 * height) noborder

plot 'data' using 1:2:(wide / 2):(high / 2):(power($3)) with boxxyerror fillstyle solid 1 noborder linecolor palette, \
	'data' using 1:2:(stringcolumn(4)) with labels noenhanced font ',11' textcolor rgb ink
