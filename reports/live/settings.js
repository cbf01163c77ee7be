// What runs, as the address says it: read, brought within what is possible, and written back. Nothing here touches the page.
const arithmetics = ["binary64", "binary32", "twin", "short"];
const covered = Math.PI / 4, packing = { convection: 0.4, discs: 0.6 };

// A number within bounds, with a note when it had to be moved.
function within(query, key, least, most, otherwise, notes, whole) {
	const word = query.get(key);
	if (word === null || word === "") return otherwise;
	const number = Number(word), asked = whole ? Math.round(number) : number;
	if (Number.isNaN(number)) {
		notes.push(`${key}: “${word.slice(0, 40)}” is no number; it is ${show(otherwise)}`);
		return otherwise;
	}
	const value = Math.min(Math.max(asked, least), most);
	if (value !== asked) notes.push(`${key}: ${show(asked)} is ${asked < least ? "too little" : "too much"}; it is ${show(value)}`);
	return value;
}

function show(number) {
	return Number.isInteger(number) && Math.abs(number) < 1e15 ? number.toLocaleString("en").replaceAll(",", "\u202f")
		: number.toPrecision(4);
}

function oneOf(word, accepted, otherwise, key, notes) {
	if (word === null || word === "") return otherwise;
	if (accepted.includes(word)) return word;
	notes.push(`${key}: “${word.slice(0, 40)}” is not known; it is ${otherwise}. Accepted: ${accepted.join(", ")}`);
	return otherwise;
}

function knownArithmetic(word) {
	const bits = /^short:(\d+)$/.exec(word);
	return bits ? bits[1] >= 4 && bits[1] <= 25 : arithmetics.includes(word) && word !== "short";
}

function readArithmetic(word, otherwise, key, notes) {
	if (word === null || word === "" || knownArithmetic(word)) return word || otherwise;
	notes.push(`${key}: “${word.slice(0, 40)}” is not known; it is ${otherwise}. Accepted: binary64, binary32, twin, short:4 to short:25`);
	return otherwise;
}

// METHOD, ARITHMETIC or METHOD@ARITHMETIC beside what the left pane has; `nothing` for one pane alone.
function readAgainst(word, left, methods, notes) {
	if (word === null) return { method: left.method, arithmetic: left.arithmetic === "binary32" ? "binary64" : "binary32" };
	if (word === "nothing") return null;
	const [method, arithmetic] = word.includes("@") ? word.split("@") : methods.includes(word) ? [word, ""] : ["", word];
	return { method: oneOf(method, methods, left.method, "against", notes),
		arithmetic: readArithmetic(arithmetic, left.arithmetic, "against", notes) };
}

// In few bits the engine must look at every pair, so that there may be only few.
function mostDiscs(scene, width, height, panes) {
	const plane = scene.dimensions === 2, longest = Math.max(width, height), limit = packing[scene.name] ?? 0.6;
	let most = plane ? Math.floor(limit / covered * width * height) : scene.dimensions === 3 ? 32000 : 500;
	let why = plane ? `packing limited to ${limit * 100} %` : "";
	if (most > 100000) [most, why] = [100000, "no more are drawn"];
	for (const { arithmetic } of panes) {
		const bits = /^short:(\d+)$/.exec(arithmetic);
		const reach = bits ? 16 * 2 ** -bits[1] * longest * (1 + longest) : 0;
		if (reach > longest / 6 && most > 1000) [most, why] = [1000, `${arithmetic} has to look at every pair`];
	}
	return [Math.max(most, 1), why];
}

// As many as the scene's file has, of which 500 show as much in the page; of discs in a plane one for an area of 6.
function usualDiscs(scene, width, height) {
	return scene.dimensions === 2 ? Math.max(1, Math.floor(width * height / 6)) : Math.min(scene.particles, 500);
}

function readSettings(query, scenes, methods, screenRatio) {
	const notes = [], aliases = { gas: "discs", ball: "bouncing-ball" }, asked = query.get("scene");
	const name = oneOf(aliases[asked] || asked, scenes.map(scene => scene.name), "convection", "scene", notes);
	const scene = scenes.find(each => each.name === name);
	const length = within(query, "length", 4, 2048, 256, notes);
	const ratio = within(query, "aspect-ratio", 0.1, 10, screenRatio, notes);
	const width = ratio >= 1 ? length : length * ratio, height = ratio >= 1 ? length / ratio : length;
	const left = { method: oneOf(query.get("method"), methods, "stable", "method", notes),
		arithmetic: readArithmetic(query.get("arithmetic"), "binary64", "arithmetic", notes) };
	const right = readAgainst(query.get("against"), left, methods, notes), panes = right ? [left, right] : [left];
	const [most, why] = mostDiscs(scene, width, height, panes);
	const usual = usualDiscs(scene, width, height);
	let nitems = within(query, "nitems", 1, most, Math.min(usual, most), notes, true);
	if (scene.given) nitems = scene.particles;
	else if (notes.at(-1)?.startsWith("nitems") && why) notes.push(notes.pop() + ` (${why})`);
	else if (usual > most) notes.push(`nitems: it is ${show(most)} (${why})`);
	return { scene, index: scenes.indexOf(scene), length, ratio, width, height, nitems, panes, notes,
		seed: within(query, "seed", 0, Number.MAX_SAFE_INTEGER, 1, notes, true),
		rate: within(query, "rate", 1e-6, 10, 0.05, notes),
		events: within(query, "events", 0, 1e12, Infinity, notes, true),
		speed: within(query, "speed", -8, 6, 0, notes, true),
		paused: query.has("paused"), draw: oneOf(query.get("draw"), ["2d", "webgl"], "", "draw", notes) };
}

// The address of these settings; what is usual is said too, so that a link means the same on another screen.
function writeSettings(s) {
	const query = new URLSearchParams({ scene: s.scene.name, length: s.length, "aspect-ratio": s.ratio, nitems: s.nitems,
		rate: s.rate, seed: s.seed, method: s.panes[0].method, arithmetic: s.panes[0].arithmetic,
		against: s.panes[1] ? `${s.panes[1].method}@${s.panes[1].arithmetic}` : "nothing", speed: s.speed });
	if (s.events < Infinity) query.set("events", s.events);
	if (s.paused) query.set("paused", "");
	if (s.draw) query.set("draw", s.draw);
	return "?" + query;
}
