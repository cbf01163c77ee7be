#version 300 es
// Cold is blue, hot red; the deeper an overlap (tenfold a seventh of the way), the more of yellow becomes magenta.
precision highp float;
in vec2 at;
in float warmth, inside, fade, edge;
uniform vec3 cold, mild, hot, sheet;
out vec4 color;

void main()
{
	float r = length(at);
	float cover = 1.0 - smoothstep(1.0 - edge, 1.0 + edge, r);
	vec3 heat = warmth < 0.5 ? mix(cold, mild, 2.0 * warmth) : mix(mild, hot, 2.0 * warmth - 1.0);
	if (inside > 0.0) {
		float level = clamp((log2(inside) / log2(10.0) + 7.0) / 6.0, 0.0, 1.0);
		heat = mix(vec3(1.0, 0.78, 0.0), vec3(0.86, 0.0, 0.72), level);
		cover = max(cover, 0.5 * (1.0 - smoothstep(1.5, 1.6 + edge, r)));
	}
	color = vec4(mix(heat, sheet, fade) * cover, cover);
}
