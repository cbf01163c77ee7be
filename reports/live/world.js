// What part of the plane is seen, {x, y, width, height}: the box, or, where there is none, a frame that follows.
const roomAround = 0.08, mostEmpty = 4; // parts of the frame

// A line lies across the picture or stands up in it; the sides, where walls may be, are seen.
function boxedWorld(scene, box) {
	const [width, height] = box, long = 1.04 * width;
	if (scene.dimensions > 1) return { x: 0, y: 0, width, height };
	if (scene.upright) return { x: 0, y: 0, width: Math.max(3, long / 3), height: long };
	return { x: 0, y: 0, width: long, height: Math.max(1.6, long / 6) };
}

function followingRatio(scene) {
	return scene.dimensions > 1 ? 1.3 : scene.upright ? 0.6 : 4;
}

// The smallest frame of that ratio around bounds [left, right, bottom, top].
function frameOf([left, right, bottom, top], ratio) {
	const wide = (right - left) * (1 + 2 * roomAround), high = (top - bottom) * (1 + 2 * roomAround);
	const height = Math.max(wide / ratio, high, 2);
	return { x: (left + right) / 2, y: (bottom + top) / 2, width: height * ratio, height };
}

// Bounds seen so far and what is to be seen now: the frame widens at once, and narrows slowly when it is mostly empty.
function follow(seen, now) {
	if (!now.every(Number.isFinite)) return seen;
	if (!seen) return now;
	const wide = Math.max(now[1] - now[0], now[3] - now[2], 1), held = Math.max(seen[1] - seen[0], seen[3] - seen[2]);
	const ease = held > mostEmpty * wide ? 0.02 : 0;
	return now.map((bound, k) => (k % 2 ? Math.max : Math.min)(bound, seen[k] + ease * (bound - seen[k])));
}

// What encloses all of several bounds.
function enclosing(bounds) {
	return [0, 1, 2, 3].map(k => (k % 2 ? Math.max : Math.min)(...bounds.map(each => each[k])));
}
