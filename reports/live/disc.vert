#version 300 es
// One disc, a square around it: two triangles. What overlaps gets a ring that is seen at any size. Discs come from a
// texture, three texels each: whole instances of four corners take a software rasteriser ten times as long.
precision highp sampler2D;
uniform sampler2D discs;
uniform int per_row;
uniform vec2 centre, half_view;
uniform float pixel;
out vec2 at;
out float warmth, inside, fade, edge;

vec2 texel(int disc, int part)
{
	return texelFetch(discs, ivec2(disc % per_row * 3 + part, disc / per_row), 0).xy;
}

void main()
{
	int disc = gl_VertexID / 6, turn = gl_VertexID % 6, corner = turn < 3 ? turn : 6 - turn;
	vec2 place = texel(disc, 0), size = texel(disc, 1), depth = texel(disc, 2);
	vec2 side = vec2(corner & 1, corner >> 1) * 2.0 - 1.0;
	float radius = max(size.x, 0.75 * pixel), outer = depth.x > 0.0 ? max(1.6 * size.x, 5.0 * pixel) : radius;
	at = side * (outer + pixel) / radius;
	edge = pixel / radius;
	warmth = size.y;
	inside = depth.x;
	fade = depth.y;
	gl_Position = vec4((place - centre + side * (outer + pixel)) / half_view, 0.0, 1.0);
}
