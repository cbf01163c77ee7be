// The engine's side: owns the WebAssembly, runs both panes to the same simulated time, and answers with pictures.
const names = ["events", "collisions", "time", "energy", "momentum_x", "momentum_y", "momentum_z", "kicked", "overlapping",
	"entangled", "dropped", "repeated", "parting", "backwards", "deepest", "deepest_ever", "first_failure", "first_sight",
	"verdict", "digest_high", "digest_low", "particles", "three_body", "captures", "releases", "bounces", "captured",
	"discs", "lines"];
const perDisc = 6, perLine = 4, budget = 11; // milliseconds of running in a picture
let engine, panes = 0, until = 0;
let ran = []; // of each pane: milliseconds of running, and events

function read(at) {
	const bytes = new Uint8Array(engine.memory.buffer);
	return new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
}

function write(...words) {
	const text = new TextEncoder().encode(words.map(word => word.slice(0, 39) + "\0").join(""));
	new Uint8Array(engine.memory.buffer).set(text, engine.live_text());
}

async function load(bytes) {
	const refuse = () => 52; // as a system without files: the engine opens none
	const wasi_snapshot_preview1 = { fd_close: refuse, fd_seek: refuse, fd_write: refuse, proc_exit: refuse };
	engine = (await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1 })).instance.exports;
	engine._initialize();
	const scenes = [], methods = [];
	for (let s = 0, at; (at = engine.live_scene_name(s)); s++) {
		const fact = f => engine.live_scene_fact(s, f);
		scenes.push({ name: read(at), title: read(engine.live_scene_title(s)), dimensions: fact(0), particles: fact(1),
			given: fact(2) === 1, upright: fact(3) === 1, follows: fact(4) === 1, states: fact(5) === 1 });
	}
	for (let m = 0, at; (at = engine.live_method(m)); m++) methods.push(read(at));
	postMessage({ type: "ready", scenes, methods });
}

function start(asked) {
	engine.live_close();
	panes = 0;
	ran = asked.panes.map(() => ({ time: 0, events: 0 }));
	const opened = { type: "started", placed: [] };
	for (const [p, pane] of asked.panes.entries()) {
		write(pane.arithmetic, pane.method);
		const placed = engine.live_open(p, asked.scene, asked.width, asked.height, asked.nitems, asked.seed);
		if (!placed) {
			opened.error = `${pane.method} in ${pane.arithmetic}: ${read(engine.live_text())}`;
			engine.live_close();
			break;
		}
		opened.placed.push(placed);
		panes = p + 1;
	}
	if (opened.error) panes = 0;
	else {
		opened.box = [engine.live_box(0, 0), engine.live_box(0, 1)];
		opened.ring = engine.live_ring(0);
		opened.walls = [];
		for (let w = 0; w < engine.live_wall_count(0); w++) {
			const at = engine.live_wall(0, w);
			if (at) opened.walls.push([...new Float64Array(engine.memory.buffer, at, 4)]);
		}
		until = engine.live_time(0);
	}
	postMessage(opened);
	if (panes) picture(true, false);
}

// Runs one pane to `time`; true when it is there, or at its end, or at `most` events in all.
function advance(p, time, most, deadline) {
	for (;;) {
		const before = ran[p].events, slice = Math.min(512, most - before), begun = performance.now();
		if (slice <= 0) return true;
		ran[p].events = engine.live_run(p, time, slice);
		const now = performance.now();
		ran[p].time += now - begun;
		if (ran[p].events - before < slice) return true;
		if (now > deadline) return false;
	}
}

function go({ span, most }) {
	const deadline = performance.now() + budget;
	let arrived = true, reached = most < Infinity;
	for (let p = 0; p < panes; p++) {
		arrived = advance(p, until + span, most, deadline + p * budget) && arrived;
		reached = reached && (ran[p].events >= most || engine.live_ended(p) === 1);
	}
	if (arrived) until += span;
	picture(arrived, reached);
}

function step() {
	for (let p = 0; p < panes; p++) {
		ran[p].events = engine.live_run(p, Infinity, 1);
		until = Math.max(until, engine.live_time(p));
	}
	picture(true, false);
}

function picture(arrived, reached) {
	const views = [], buffers = [];
	for (let p = 0; p < panes; p++) {
		if (!engine.live_look(p)) throw new Error("not enough memory");
		const numbers = new Float64Array(engine.memory.buffer, engine.live_counts(p), names.length);
		const counts = Object.fromEntries(names.map((name, k) => [name, numbers[k]]));
		const copy = (at, count) => new Float32Array(engine.memory.buffer, at, count).slice();
		const discs = copy(engine.live_discs(p), counts.discs * perDisc), lines = copy(engine.live_lines(p), counts.lines * perLine);
		const bounds = [...new Float64Array(engine.memory.buffer, engine.live_bounds(p), 4)];
		counts.digest = [counts.digest_high, counts.digest_low].map(half => half.toString(16).padStart(8, "0")).join("");
		counts.pace = ran[p].time > 0 ? counts.collisions / ran[p].time * 1000 : 0;
		const [reason, ...log] = read(engine.live_tell(p)).split("\n");
		views.push({ discs, lines, bounds, counts, reason, log });
		buffers.push(discs.buffer, lines.buffer);
	}
	postMessage({ type: "picture", views, horizon: engine.live_horizon(), until, arrived, reached }, buffers);
}

onmessage = ({ data }) => {
	try {
		if (data.type === "load") load(data.bytes).catch(error => postMessage({ type: "broken", error: String(error) }));
		else if (data.type === "start") start(data);
		else if (data.type === "go" && panes) go(data);
		else if (data.type === "step" && panes) step();
	} catch (error) {
		postMessage({ type: "broken", error: String(error) });
	}
};
