# A value over a plane, one cell a point, on a logarithmic scale of colours; cells without a value are left white. What is
# printed in a cell is the word of its point. Columns: x y value.

eval paper(860, 560)
unset grid
unset key
set xlabel x_label
set ylabel y_label
set lmargin 11
set rmargin 12
set border 15 linewidth 1 linecolor rgb soft

# The distance of two neighbours: cells fill the plane.
stats 'data' using 1 name 'across' nooutput
stats 'data' using 2 name 'up' nooutput
pitch(low, high, number) = number > 1 ? (high - low) / (number - 1) : 1
array places[2]
do for [axis = 1:2] {
	seen = ''; number = 0
	do for [k = 0:(across_records - 1)] {
		stats 'data' using axis every ::k::k name 'one' nooutput
		word_of = sprintf(' %.6g ', one_min)
		if (strstrt(seen, word_of) == 0) { seen = seen.word_of; number = number + 1 }
	}
	places[axis] = number
}
wide = pitch(across_min, across_max, places[1])
high = pitch(up_min, up_max, places[2])
set xrange [across_min - wide / 2:across_max + wide / 2]
set yrange [up_min - high / 2:up_max + high / 2]

stats 'data' using ($3 > 0 ? log10($3) : NaN) name 'value' nooutput
least = exists('value_min') ? floor(value_min) : -1
most = exists('value_max') ? ceil(value_max) : 0
set cbrange [least:(most > least ? most : least + 1)]
set palette defined (0 '#f2f6fb', 0.35 '#a9c8e8', 0.65 '#e8b07a', 1 '#c23b3b')
set format cb '10^{%.0f}'
set cbtics 1 textcolor rgb ink
set colorbox user origin graph 1.02, graph 0 size graph 0.03, graph 1 noborder

plot 'data' using 1:2:(wide / 2):(high / 2):($3 > 0 ? log10($3) : NaN) with boxxyerror fillstyle solid 1 noborder \
		linecolor palette, \
	'data' using 1:2:4 with labels textcolor rgb ink
