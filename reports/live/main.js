// The page: starts what the address asks for, asks the worker for pictures, draws them, and heeds the controls.
const at = id => document.getElementById(id);
let scenes, methods, settings, worker, draw = [], latest = null, fresh = false, busy = false, started = false;
let world, seen, walls = [], ring = 0; // what part of the plane is in sight, and what stands in it
let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, shownCounts = 0, restarts = 0;

function say(lines) {
	at("notes").replaceChildren(...lines.map(line => {
		const each = document.createElement("span");
		each.textContent = line;
		return each;
	}));
}

function setPlaying(on) {
	playing = on;
	at("pause").textContent = on ? "Pause" : "Run";
}

// ---------------------------------------------------------------- controls

function fill(select, words, chosen, label = word => word) {
	select.replaceChildren(...words.map(word => new Option(label(word), word, false, word === chosen)));
}

function showPane(p, pane) {
	const [word, bits] = (pane ? pane.arithmetic : "none").split(":");
	fill(at(`method-${p}`), methods, pane ? pane.method : methods[0]);
	const names = { binary64: "binary64: double", binary32: "binary32: float", twin: "twin: two doubles", short: "short: fewer bits",
		none: "nothing" };
	fill(at(`arithmetic-${p}`), p ? [...arithmetics, "none"] : arithmetics, word, name => names[name]);
	at(`bits-${p}`).value = at(`bits-text-${p}`).value = bits || 16;
	at(`bits-${p}`).closest("label").hidden = word !== "short";
	at(`method-${p}`).disabled = !pane;
}

function showControls() {
	const s = settings;
	fill(at("scene"), scenes.map(scene => scene.name), s.scene.name, name => scenes.find(each => each.name === name).title);
	at("nitems").value = s.nitems;
	at("nitems").disabled = s.scene.given;
	at("length").value = s.length;
	at("length").closest("label").hidden = s.scene.dimensions !== 2 || s.scene.given;
	at("seed").value = s.seed;
	at("speed").value = s.speed;
	showSpeed();
	[0, 1].forEach(p => showPane(p, s.panes[p]));
}

function showSpeed() {
	const speed = settings.speed, text = speed >= 0 ? `${2 ** speed} ×` : `1/${2 ** -speed} ×`;
	at("speed-text").value = text;
	at("speed").setAttribute("aria-valuetext", text);
}

function arithmeticOf(p) {
	const word = at(`arithmetic-${p}`).value;
	return word === "short" ? `short:${at(`bits-${p}`).value}` : word;
}

// The controls as an address, read like any other.
function fromControls(changed) {
	const query = new URLSearchParams(writeSettings(settings));
	if (changed === "scene") ["nitems", "length", "speed"].forEach(key => query.delete(key));
	if (changed === "length") query.delete("nitems");
	else if (changed === "nitems") query.set("nitems", at("nitems").value);
	if (changed !== "scene") query.set("length", at("length").value);
	for (const key of ["scene", "seed"]) query.set(key, at(key).value);
	query.set("method", at("method-0").value);
	query.set("arithmetic", arithmeticOf(0));
	query.set("against", arithmeticOf(1) === "none" ? "nothing" : `${at("method-1").value}@${arithmeticOf(1)}`);
	query.delete("events");
	start(query);
}

// ---------------------------------------------------------------- a run

function start(query) {
	settings = readSettings(query, scenes, methods, screen.width / screen.height || 1.6);
	showControls();
	say(settings.notes);
	history.replaceState(null, "", writeSettings(settings));
	settings.panes.forEach((pane, p) => at(`caption-${p}`).dataset.name = paneName(pane));
	at("pane-1").hidden = settings.panes.length < 2;
	at("heat").textContent = settings.scene.name === "convection" ? "cold to hot" : "slow to fast";
	layOutCounts(settings.panes, settings.scene);
	started = fresh = false;
	latest = null;
	busy = true;
	pace.restart();
	const { panes, index, width, height, nitems, seed } = settings;
	worker.postMessage({ type: "start", panes, scene: index, width, height, nitems, seed });
}

function makeWorld(opened) {
	const { scene } = settings;
	({ walls, ring } = opened);
	seen = null;
	world = scene.follows ? null : boxedWorld(scene, opened.box);
	const ratio = world ? world.width / world.height : followingRatio(scene);
	document.documentElement.style.setProperty("--ratio", ratio);
	at("look").textContent = lookOf(scene, ring);
	[0, 1].forEach(p => delete at(`marks-${p}`).dataset.key);
}

function begun(message) {
	busy = false;
	if (message.error) {
		latest = null;
		say([...settings.notes, message.error]);
		return;
	}
	makeWorld(message);
	const placed = message.placed[0];
	if (placed < settings.nitems) {
		settings.notes.push(`nitems: room was found for ${show(placed)} of ${show(settings.nitems)}`);
		say(settings.notes);
	}
	started = true;
	restarts++;
	document.documentElement.dataset.run = restarts;
}

function picture(message) {
	if (!started) return; // of the run before
	busy = false;
	latest = message;
	fresh = true;
	if (settings.scene.follows) {
		seen = follow(seen, enclosing(latest.views.map(view => view.bounds)));
		world = frameOf(seen || [-2, 2, -2, 2], followingRatio(settings.scene));
	}
	if (message.reached) setPlaying(false);
	at("pace").textContent = message.arrived ? "" : "slower than asked: the engine takes longer than a picture";
}

function drawViews() {
	latest.views.forEach((view, p) => {
		const canvas = at(`canvas-${p}`);
		draw[p] ||= drawer(canvas, settings.draw);
		draw[p](view.discs, world);
		drawMarks(at(`marks-${p}`), canvas, world, walls, ring, view);
	});
}

function showPicture(now) {
	fresh = false;
	drawViews();
	if (playing && now - shownCounts < 150) return;
	shownCounts = now;
	writeCaptions(latest.views);
	writeCounts(latest.views);
	writeHorizon(latest.horizon, latest.views.length);
	if (!playing) writeLog(latest.views);
}

// The worker is asked for the next picture before the last one is drawn, so that both are at work.
function frame(now) {
	requestAnimationFrame(frame);
	const begun = performance.now(), drawn = fresh;
	if (playing && !busy && started) {
		busy = true;
		worker.postMessage({ type: "go", span: settings.rate * 2 ** settings.speed, most: settings.events });
	}
	if (drawn) showPicture(now);
	if (playing && !document.hidden) pace.note(now, drawn, performance.now() - begun);
}

function step() {
	setPlaying(false);
	pace.restart();
	if (busy || !started) return;
	busy = true;
	worker.postMessage({ type: "step" });
}

function togglePause() {
	setPlaying(!playing);
	pace.restart();
	if (!playing && latest) writeLog(latest.views);
	if (playing && settings.events < Infinity && latest?.reached) settings.events = Infinity;
}

function restart() {
	start(new URLSearchParams(writeSettings(settings)));
}

function listen() {
	for (const id of ["scene", "nitems", "length", "seed", "method-0", "method-1", "arithmetic-0", "arithmetic-1", "bits-0", "bits-1"])
		at(id).addEventListener("change", () => fromControls(id));
	for (const p of [0, 1]) at(`bits-${p}`).addEventListener("input", () => at(`bits-text-${p}`).value = at(`bits-${p}`).value);
	at("controls").addEventListener("submit", event => event.preventDefault());
	at("pause").addEventListener("click", togglePause);
	at("step").addEventListener("click", step);
	at("restart").addEventListener("click", restart);
	at("speed").addEventListener("input", () => {
		settings.speed = Number(at("speed").value);
		showSpeed();
		history.replaceState(null, "", writeSettings(settings));
	});
	document.addEventListener("keydown", event => {
		const key = { " ": togglePause, ".": step, r: restart }[event.key];
		if (!key || event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, select, button, summary, a")) return;
		event.preventDefault();
		key();
	});
	[0, 1].forEach(p => fit(at(`canvas-${p}`), () => latest && drawViews())); // at once, for a new size is blank
	matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => fresh = latest !== null);
}

function hear({ data }) {
	if (data.type === "ready") {
		({ scenes, methods } = data);
		const query = new URLSearchParams(location.search);
		if (query.has("paused")) setPlaying(false);
		listen();
		start(query);
		requestAnimationFrame(frame);
	} else if (data.type === "started") begun(data);
	else if (data.type === "picture") picture(data);
	else {
		started = false;
		say([`The engine has stopped: ${data.error}. Restart, or ask for less.`]);
		busy = false;
	}
}

function begin() {
	setPlaying(playing);
	const bytes = Uint8Array.from(atob(at("engine").textContent.trim()), character => character.charCodeAt(0)).buffer;
	worker = new Worker(URL.createObjectURL(new Blob([at("worker").textContent], { type: "text/javascript" })));
	worker.onmessage = hear;
	worker.onerror = event => say([`The engine could not be started: ${event.message || "this browser allows no workers here"}`]);
	worker.postMessage({ type: "load", bytes }, [bytes]);
}

begin();
