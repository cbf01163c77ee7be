// Discs on a canvas, in one of three ways that look alike: by a graphics card; where there is none, by setting pixels
// from masks drawn beforehand, which takes a tenth of the time that software takes to be a graphics card; and large
// discs by an ordinary canvas. A disc is x, y, radius, warmth, depth of overlap, fade (verify/live/view.h).
const floatsPerDisc = 6, largestMask = 24; // pixels

function channels(color) {
	return [1, 3, 5].map(k => parseInt(color.slice(k, k + 2), 16));
}

// The page's colours, read anew when they change: asking the style sheet for them takes long.
let colors;
function palette() {
	const style = colors || getComputedStyle(document.documentElement);
	return colors ||= Object.fromEntries(["cold", "mild", "hot", "sheet", "soft"].map(name =>
		[name, channels(style.getPropertyValue("--" + name).trim())]));
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => colors = null);

function blend(from, to, part) {
	return from.map((channel, k) => channel + (to[k] - channel) * part);
}

const shallow = [255, 199, 0], deep = [219, 0, 184];

// The colour of a disc, as red, green and blue.
function colorOf(warmth, depth, fade) {
	const { cold, mild, hot, sheet } = palette();
	if (depth > 0) return blend(shallow, deep, Math.min(Math.max((Math.log10(depth) + 7) / 6, 0), 1));
	return blend(warmth < 0.5 ? blend(cold, mild, 2 * warmth) : blend(mild, hot, 2 * warmth - 1), sheet, fade);
}

// What overlaps is drawn wide enough to be seen at any size.
function outerRadius(radius, depth) {
	return depth > 0 ? Math.max(1.6 * radius, 5) : Math.max(radius, 0.75);
}

function drawPaths(canvas, context, discs, world) {
	const scale = canvas.width / world.width;
	context.fillStyle = `rgb(${palette().sheet})`;
	context.fillRect(0, 0, canvas.width, canvas.height);
	for (let k = 0; k < discs.length; k += floatsPerDisc) {
		const x = (discs[k] - world.x) * scale + canvas.width / 2, y = canvas.height / 2 - (discs[k + 1] - world.y) * scale;
		const radius = discs[k + 2] * scale, depth = discs[k + 4];
		const circle = wide => {
			context.beginPath();
			context.arc(x, y, wide, 0, 2 * Math.PI);
			context.fill();
		};
		context.fillStyle = `rgb(${colorOf(discs[k + 3], depth, discs[k + 5]).map(Math.round)})`;
		if (depth > 0) {
			context.globalAlpha = 0.5;
			circle(outerRadius(radius, depth));
			context.globalAlpha = 1;
		}
		circle(Math.max(radius, 0.75));
	}
}

function largestRadius(discs) {
	let largest = 0;
	for (let k = 2; k < discs.length; k += floatsPerDisc) if (discs[k] > largest) largest = discs[k];
	return largest;
}

function drawBySoftware(canvas) {
	const context = canvas.getContext("2d", { alpha: false }), setPixels = pixelSetter(canvas, context);
	return (discs, world) => {
		const small = largestRadius(discs) * canvas.width / world.width <= largestMask;
		(small ? setPixels : drawPaths.bind(null, canvas, context))(discs, world);
	};
}

// Whether there is a graphics card, and not software in its place, which browsers do not always own up to.
function hasCard() {
	const gl = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: true });
	if (!gl) return false;
	const unmasked = gl.getExtension("WEBGL_debug_renderer_info"), name = gl.getParameter(unmasked?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
	gl.getExtension("WEBGL_lose_context")?.loseContext();
	return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

// What draws on a canvas: a function of discs and world, the part of the plane to be seen {x, y, width, height}. The
// `way` may be said: "2d", or "webgl" even by software.
function drawer(canvas, way) {
	const wanted = way === "webgl" || !way && hasCard();
	const gl = wanted ? canvas.getContext("webgl2", { antialias: false, alpha: false }) : null;
	canvas.dataset.drawn = gl ? "webgl2" : "2d";
	return gl ? drawByCard(canvas, gl) : drawBySoftware(canvas);
}

// Keeps a canvas at as many pixels as the screen has for it, whatever the zoom; `changed` is told.
function fit(canvas, changed) {
	const whole = new ResizeObserver(([entry]) => {
		const density = window.devicePixelRatio || 1, exact = entry.devicePixelContentBoxSize?.[0], box = entry.contentRect;
		const width = Math.max(1, Math.round(exact ? exact.inlineSize : box.width * density));
		const height = Math.max(1, Math.round(exact ? exact.blockSize : box.height * density));
		if (canvas.width === width && canvas.height === height) return;
		[canvas.width, canvas.height] = [width, height];
		changed();
	});
	try {
		whole.observe(canvas, { box: "device-pixel-content-box" });
	} catch {
		whole.observe(canvas);
	}
}
