# A measure over the days: the band it usually lies in, each night with its interval, and nights that were found worse.
# Columns: time (seconds since 1970) y low high. Lines are bands from low to high around y; points are nights; ends are
# those that stand out.

left_edge = 82; right_edge = 42; top_edge = 34; bottom_edge = 44
width = 860; height = 300
sizing = 'dynamic'
eval paper(width, height)
set lmargin at screen 1.0 * left_edge / width
set rmargin at screen 1.0 - 1.0 * right_edge / width
set tmargin at screen 1.0 - 1.0 * top_edge / height
set bmargin at screen 1.0 * bottom_edge / height
unset xlabel
set label 1 y_label at screen (16.0 / width), graph 0.5 center rotate by 90 textcolor rgb ink

stats 'data' using 1 name 'across' nooutput
stats 'data' using 2 name 'middle' nooutput
stats 'data' using 3 name 'low' nooutput
stats 'data' using 4 name 'high' nooutput
day = 86400.0
spare = across_max - across_min < 6 * day ? (6 * day - (across_max - across_min)) / 2 : 0 # no less than some days
left_x = across_min - 0.02 * (across_max - across_min) - 0.2 * day - spare
right_x = across_max + 0.02 * (across_max - across_min) + 0.2 * day + spare
least = exists('low_records') && low_records > 0 && low_min < middle_min ? low_min : middle_min
most = exists('high_records') && high_records > 0 && high_max > middle_max ? high_max : middle_max
air = most > least ? 0.06 * (most - least) : most != 0 ? 0.1 * abs(most) : 1
low_y = least - air; high_y = most + air
set yrange [low_y:high_y]

# Where the points are, for what answers to the pointer.
if (!pdf) {
	set table 'marks'
	do for [i = 1:series_count] {
		plot 'data' index i - 1 using (i - 1):0:(left_edge + (width - left_edge - right_edge) * ($1 - left_x) / (right_x - left_x)):(top_edge + (height - top_edge - bottom_edge) * (high_y - $2) / (high_y - low_y)) with table
	}
	unset table
}

bands = ''; nights = ''; findings = ''
do for [i = 1:series_count] {
	if (style[i] eq 'line') { bands = bands.' '.i }
	if (style[i] eq 'points') { nights = nights.' '.i }
	if (style[i] eq 'ends') { findings = findings.' '.i }
}
set xdata time
set timefmt '%s'
set format x '%Y-%m-%d'
set xrange [left_x:right_x]
if (right_x - left_x < 10 * day) { set xtics day } else { set xtics autofreq }
set xtics nomirror scale 0.6 textcolor rgb ink
set key at screen 1.0 * left_edge / width, screen 1.0 - 6.0 / height left top horizontal maxrows 1 Left reverse samplen 2 width -2
plot for [k = 1:words(bands)] 'data' index nth(bands, k) - 1 using ($1):3:4 with filledcurves \
		fillcolor rgb '#dbe6f3' fillstyle solid 1 noborder title series[nth(bands, k)], \
	for [k = 1:words(bands)] 'data' index nth(bands, k) - 1 using ($1):2 with lines linecolor rgb '#9dbbdc' linewidth 1.2 notitle, \
	for [k = 1:words(nights)] 'data' index nth(nights, k) - 1 using ($1):3:(0):($4 - $3) with vectors nohead linecolor rgb '#c3c9d0' linewidth 0.8 notitle, \
	for [k = 1:words(nights)] 'data' index nth(nights, k) - 1 using ($1):2 with points linecolor rgb blue pointtype 7 pointsize 0.4 title series[nth(nights, k)], \
	for [k = 1:words(findings)] 'data' index nth(findings, k) - 1 using ($1):2 with points linecolor rgb red pointtype 9 pointsize 0.9 title series[nth(findings, k)]
