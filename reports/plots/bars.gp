# Grouped bars, lying, so that names of any length can be read. Columns: category value low high. The x axis of the
# figure is that of the categories, its y axis that of the values.

rows_drawn = category_count > 0 ? category_count : 1
longest = 4
do for [i = 1:category_count] { longest = strlen(category[i]) > longest ? strlen(category[i]) : longest }
eval paper(860, 80 + 18 * series_count + rows_drawn * (20 + 14 * series_count))

unset logscale
set format '%g'
set autoscale
eval log_axis('x', y_log)
stats 'data' using ($2 > 0 ? $2 : NaN) name 'positive' nooutput
base = y_log ? y_log**floor(log(positive_min) / log(y_log) - 0.001) : 0
stats 'data' using 2 name 'value' nooutput
set xrange [y_log ? base : value_min < 0 ? value_min : 0:*]
eval given_range('x', y_given, y_low, y_high)
if (y_log && y_given) { base = y_low }

set yrange [rows_drawn - 0.4:-0.6]
set xlabel y_label
unset ylabel
set lmargin 0.72 * longest + 3
set border 1
set ytics scale 0 ('' -1)
set for [i = 1:category_count] ytics add (category[i] i - 1)
set grid xtics noytics
set key vertical maxcols 1

thickness = 0.8 / series_count
middle(at, i) = at + (i - (series_count + 1) / 2.0) * thickness
half = 0.45 * thickness
plot for [i = 1:series_count] 'data' index i - 1 \
		using 2:(middle($1, i)):(base):2:(middle($1, i) - half):(middle($1, i) + half) with boxxyerror \
		fillstyle solid 0.8 noborder linecolor rgb colour(i) title series[i], \
	for [i = 1:series_count] 'data' index i - 1 using 3:(middle($1, i)):($4 - $3):(0) with vectors nohead \
		linecolor rgb ink linewidth 1.2 notitle
