// What is written beside the pictures: captions, counts, the horizon, the last events.
const verdicts = ["", "collapsed: events go on but time does not", "halted: no answer for the state it is in", "diverged"];
const rows = [
	["time", "Time", c => c.time.toPrecision(Math.abs(c.time) < 1e5 ? 8 : 12)],
	["events", "Events", c => show(c.events)],
	["collisions", "Collisions", c => show(c.collisions)],
	["states", "Captures, releases, turned back", c => `${show(c.captures)}, ${show(c.releases)}, ${show(c.bounces)}`],
	["captured", "Captured pairs now", c => show(c.captured)],
	["pace", "Collisions per second of computing", c => show(Math.round(c.pace))],
	["energy", "Energy", c => c.energy.toPrecision(7)],
	["kicked", "of which kicks brought in", c => c.kicked ? c.kicked.toPrecision(7) : "–"],
	["momentum", "Momentum", c => `(${[c.momentum_x, c.momentum_y, c.momentum_z].map(part => part.toPrecision(3)).join(", ")})`],
	["overlapping", "Overlapping now", c => show(c.overlapping)],
	["entangled", "Entangled", c => show(c.entangled)],
	["deepest", "Deepest overlap, now and ever", c => `${share(c.deepest)}, ${share(c.deepest_ever)}`],
	["dropped", "Dropped", c => show(c.dropped)],
	["repeated", "Repeated", c => show(c.repeated)],
	["parting", "Parting", c => show(c.parting)],
	["backwards", "Backwards", c => show(c.backwards)],
	["three_body", "Three-body events", c => show(c.three_body)],
	["failure", "First failure", c => moment(c.first_failure)],
	["sight", "First visible failure", c => moment(c.first_sight)],
	["digest", "Digest", c => c.digest],
];

// Which of them a scene has something to say in.
let told = rows;
const ofStates = new Set(["states", "captured"]);

function share(depth) {
	return depth === 0 ? "none" : `${(100 * depth).toPrecision(2)} %`;
}

function moment(time) {
	return Number.isNaN(time) ? "none yet" : `t = ${time.toPrecision(6)}`;
}

function paneName(pane) {
	return `${pane.method} in ${pane.arithmetic}`;
}

function layOutCounts(panes, scene) {
	told = rows.filter(([name]) => scene.states || !ofStates.has(name));
	const table = document.getElementById("counts");
	table.replaceChildren();
	const head = table.createTHead().insertRow();
	for (const text of ["", ...panes.map(paneName)]) {
		const cell = document.createElement("th");
		cell.scope = "col";
		cell.textContent = text;
		head.append(cell);
	}
	const body = table.createTBody();
	for (const [name, label] of told) {
		const row = body.insertRow(), th = document.createElement("th");
		th.scope = "row";
		th.textContent = label;
		row.append(th);
		panes.forEach((_, p) => row.insertCell().id = `${name}-${p}`);
	}
}

const alarming = new Set(["overlapping", "entangled", "dropped", "repeated", "parting", "backwards", "three_body"]);

function writeCounts(views) {
	views.forEach(({ counts }, p) => {
		for (const [name, , say] of told) {
			const cell = document.getElementById(`${name}-${p}`);
			cell.textContent = say(counts);
			cell.classList.toggle("alarm", alarming.has(name) && counts[name] > 0
				|| (name === "failure" || name === "sight") && !Number.isNaN(counts[`first_${name}`]));
		}
	});
}

function writeHorizon(horizon, panes) {
	const line = document.getElementById("horizon"), differ = horizon >= 0;
	line.hidden = panes < 2;
	line.textContent = differ ? `Horizon: the panes differ from event ${show(horizon + 1)} on.`
		: `No difference yet: both executed the same ${show(-1 - horizon)} events.`;
	line.classList.toggle("alarm", differ);
	line.dataset.events = differ ? horizon : "";
}

function writeLog(views) {
	const table = document.getElementById("log");
	table.replaceChildren();
	views.forEach(({ log }, p) => {
		const body = table.createTBody(), head = document.createElement("th");
		head.colSpan = 4;
		head.scope = "rowgroup";
		head.textContent = document.getElementById(`caption-${p}`).dataset.name;
		body.insertRow().append(head);
		for (const line of log.slice(0, 6)) {
			const row = body.insertRow();
			for (const word of line.split("\t")) row.insertCell().textContent = word;
		}
	});
}

function writeCaptions(views) {
	views.forEach(({ counts, reason }, p) => {
		const caption = document.getElementById(`caption-${p}`), canvas = document.getElementById(`canvas-${p}`);
		const verdict = verdicts[counts.verdict], ended = verdict ? `${verdict}${reason ? ` – ${reason}` : ""}` : "";
		const state = ended || (counts.overlapping ? `${show(counts.overlapping)} pairs inside one another` : "");
		caption.textContent = `${caption.dataset.name}${state ? ": " + state : ""}`;
		caption.classList.toggle("alarm", counts.verdict >= 2 || counts.overlapping > 0);
		canvas.setAttribute("aria-label", `${caption.textContent}. ${show(counts.particles)} particles at t = ${counts.time.toPrecision(4)}`);
	});
}

// What else is to be seen, for the legend.
function lookOf(scene, ring) {
	const words = [];
	if (scene.dimensions === 3)
		words.push("Three dimensions, seen along the third: nearer spheres cover those behind them, which fade; overlaps are drawn on top.");
	if (scene.follows) words.push("There is no box: the picture follows the particles.");
	if (ring) words.push(`Rings (where they are not too many) touch where two are at the step, at a distance of ${show(2 * ring)}. Captured pairs are joined, up to 1000 of them.`);
	return words.join(" ");
}
