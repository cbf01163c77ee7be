#version 300 es
// One disc, a square around it: four corners of a strip. What overlaps gets a ring that is seen at any size.
uniform vec2 half_box;
uniform float shift, pixel;
in vec4 disc; // x, y, radius, warmth
in float depth;
out vec2 at;
out float warmth, inside, edge;

void main()
{
	vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
	float radius = max(disc.z, 0.75 * pixel), outer = depth > 0.0 ? max(1.6 * disc.z, 5.0 * pixel) : radius;
	at = corner * (outer + pixel) / radius;
	edge = pixel / radius;
	warmth = disc.w;
	inside = depth;
	gl_Position = vec4((vec2(disc.x + shift, disc.y) + corner * (outer + pixel)) / half_box, 0.0, 1.0);
}
