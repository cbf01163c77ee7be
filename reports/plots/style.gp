# What all plots share. `pdf` says which file is being drawn; the colours are those of the pages in light dress, and
# the pages turn them over in dark dress.

ink = '#24292f'; quiet = '#5f6871'; soft = '#8a919a'; faint = '#dfe3e8'
blue = '#2f6db3'; orange = '#c8641c'; green = '#3d8b4f'; purple = '#7f56a8'; red = '#c23b3b'; teal = '#2a8c94'
colour(i) = word('#2f6db3 #c8641c #3d8b4f #7f56a8 #2a8c94 #c23b3b', (i - 1) % 6 + 1)

# Opens the file for a plot of so many pixels, 96 to the inch; a scalable one fills the room it is given.
sizing = 'fixed'
paper(width, height) = pdf ? sprintf("set terminal pdfcairo enhanced size %gin,%gin font 'sans,7.4' fontscale 1 lw 1.3; set output 'figure.pdf'", width / 96.0, height / 96.0) \
	: sprintf("set terminal svg enhanced %s size %d,%d font 'system-ui, Helvetica, Arial, sans-serif,13'; set output 'figure.svg'", sizing, width, height)

# The series of a list such as '1 3'. A plot over an empty list is never drawn, but its words are read once.
nth(list, k) = words(list) >= k ? int(word(list, k)) : 1

set border 3 linewidth 1 linecolor rgb soft
set tics nomirror scale 0.6 textcolor rgb ink
set grid linetype 1 linewidth 0.7 linecolor rgb faint
set key outside above left horizontal Left reverse samplen 2 textcolor rgb ink
set minussign
set xlabel textcolor rgb ink
set ylabel textcolor rgb ink
set samples 400

superscript(n) = sprintf('10^{%s%d}', n < 0 ? '−' : '', abs(n))

# Logarithmic axes by base, with tick labels to match.
log_axis(axis, base) = base == 0 ? '' \
	: base == 2 ? sprintf("set logscale %s 2; set format %s '2^{%%L}'", axis, axis) \
	: sprintf("set logscale %s 10; set format %s '10^{%%T}'", axis, axis)
given_range(axis, given, low, high) = given ? sprintf('set %srange [%.17g:%.17g]', axis, low, high) : ''

# A range with some air around what is to be seen, so that no mark sits on the edge.
roomy(axis, base, low, high) = base == 0 ? sprintf('set %srange [%.17g:%.17g]', axis, low - 0.04 * span(low, high), high + 0.04 * span(low, high)) \
	: sprintf('set %srange [%.17g:%.17g]', axis, low * (low / high)**0.04, high * (high / low)**0.04)
span(low, high) = high > low ? high - low : 1
visible(base, value) = base > 0 && value <= 0 ? NaN : value

eval log_axis('x', x_log)
eval log_axis('y', y_log)
eval given_range('x', x_given, x_low, x_high)
eval given_range('y', y_given, y_low, y_high)

