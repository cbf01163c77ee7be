// Discs by setting pixels, from masks: how much of each pixel a disc covers, for its size and for where in a pixel its
// centre lies, in quarters. Sizes are told apart by eighths of a pixel.
const quarters = 4, shades = 32, fades = 8;

// How much of each pixel around the one with the centre in it is covered, 0 to 256, and between which columns of each
// row that is anything.
function maskOf(radius, marked, qx, qy) {
	const outer = outerRadius(radius, marked), reach = Math.ceil(outer + 0.5), side = 2 * reach + 1;
	const cover = new Uint16Array(side * side), from = new Int16Array(side).fill(side), to = new Int16Array(side);
	const within = (r, limit) => Math.min(Math.max(limit - r + 0.5, 0), 1);
	for (let y = 0; y < side; y++)
		for (let x = 0; x < side; x++) {
			const r = Math.hypot(x + 0.5 - reach - (qx + 0.5) / quarters, y + 0.5 - reach - (qy + 0.5) / quarters);
			const part = Math.max(within(r, Math.max(radius, 0.75)), marked ? 0.5 * within(r, outer) : 0);
			cover[y * side + x] = Math.round(256 * part);
			if (cover[y * side + x] === 0) continue;
			from[y] = Math.min(from[y], x);
			to[y] = x + 1;
		}
	return { reach, side, cover, from, to };
}

function maskStore() {
	const sizes = new Map();
	return (radius, marked) => {
		const key = 2 * Math.round(8 * radius) + (marked ? 1 : 0);
		let masks = sizes.get(key);
		if (masks) return masks;
		if (sizes.size >= 64) sizes.clear();
		masks = Array.from({ length: quarters ** 2 }, (_, k) => maskOf(Math.round(8 * radius) / 8, marked ? 1 : 0, k % quarters, k >> 2));
		sizes.set(key, masks);
		return masks;
	};
}

// Red, green and blue as a pixel has them in memory, on machines that put the lowest byte first.
function packed([red, green, blue]) {
	return (0xff000000 | Math.round(blue) << 16 | Math.round(green) << 8 | Math.round(red)) >>> 0;
}

// Colours of warmth and fade; and of depth, which come after them.
function colorTable() {
	const table = new Uint32Array(shades * fades + shades);
	for (let s = 0; s < shades; s++) {
		for (let f = 0; f < fades; f++) table[s * fades + f] = packed(colorOf(s / (shades - 1), 0, f / (fades - 1)));
		table[shades * fades + s] = packed(colorOf(0, 10 ** (6 * s / (shades - 1) - 7), 0));
	}
	return table;
}

function colorIndex(warmth, depth, fade) {
	if (!(depth > 0)) return Math.round(warmth * (shades - 1)) * fades + Math.round(fade * (fades - 1));
	return shades * fades + Math.round(Math.min(Math.max((Math.log10(depth) + 7) / 6, 0), 1) * (shades - 1));
}

// Lays a colour over the pixels that a mask covers, two channels at a time.
function stamp(pixels, width, height, mask, left, top, color) {
	const odd = color & 0xff00ff, even = color & 0xff00, { side, cover, from, to } = mask;
	const last = Math.min(side, height - top);
	for (let y = Math.max(0, -top); y < last; y++) {
		const row = (top + y) * width + left, line = y * side, end = Math.min(to[y], width - left);
		for (let x = Math.max(from[y], -left); x < end; x++) {
			const part = cover[line + x];
			if (part === 256) pixels[row + x] = color;
			else {
				const old = pixels[row + x], rest = 256 - part;
				pixels[row + x] = 0xff000000 | ((old & 0xff00ff) * rest + odd * part) >>> 8 & 0xff00ff
					| ((old & 0xff00) * rest + even * part) >>> 8 & 0xff00;
			}
		}
	}
}

function pixelSetter(canvas, context) {
	const masksOf = maskStore();
	let image, pixels, table, shown;
	return (discs, world) => {
		const { width, height } = canvas, scale = width / world.width;
		if (image?.width !== width || image?.height !== height) {
			image = context.createImageData(width, height);
			pixels = new Uint32Array(image.data.buffer);
		}
		if (shown !== palette()) [shown, table] = [palette(), colorTable()];
		pixels.fill(packed(shown.sheet));
		const left = width / 2 - world.x * scale, top = height / 2 + world.y * scale;
		let radius = -1, marked, masks;
		for (let k = 0; k < discs.length; k += floatsPerDisc) {
			const x = left + discs[k] * scale, y = top - discs[k + 1] * scale, depth = discs[k + 4];
			if (discs[k + 2] !== radius || depth > 0 !== marked) {
				[radius, marked] = [discs[k + 2], depth > 0];
				masks = masksOf(radius * scale, marked);
			}
			const px = Math.floor(x), py = Math.floor(y), { reach } = masks[0];
			if (!(px + reach >= 0 && px - reach < width && py + reach >= 0 && py - reach < height)) continue;
			const mask = masks[Math.floor((y - py) * quarters) * quarters + Math.floor((x - px) * quarters)];
			stamp(pixels, width, height, mask, px - reach, py - reach, table[colorIndex(discs[k + 3], depth, discs[k + 5])]);
		}
		context.putImageData(image, 0, 0);
	};
}
