// What is drawn over the discs: walls, rings half as wide as a step is far, lines between captured pairs.
const mostCovered = 2; // by rings, of the picture's area: where there are more of them none is told from another

function drawWall(context, scale, world, [x, y, nx, ny]) {
	const corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]].map(([a, b]) =>
		(world.x + a * world.width / 2 - x) * nx + (world.y + b * world.height / 2 - y) * ny);
	if (Math.min(...corners) * scale > -1.5 || Math.max(...corners) < 0) return; // the frame's own side, or out of sight
	const long = world.width + world.height, foot = (world.x - x) * nx + (world.y - y) * ny;
	const point = (along, behind) => context.lineTo((-(foot + behind) * nx - along * ny) * scale,
		((foot + behind) * ny - along * nx) * scale);
	context.beginPath();
	for (const [along, behind] of [[-long, 0], [long, 0], [long, long], [-long, long]]) point(along, behind);
	context.globalAlpha = 0.25;
	context.fill();
	context.globalAlpha = 1;
	context.beginPath();
	point(-long, 0);
	point(long, 0);
	context.stroke();
}

function drawRings(context, scale, world, discs, ring) {
	context.beginPath();
	for (let k = 0; k < discs.length; k += floatsPerDisc) {
		if (discs[k + 5] === 1) continue; // a rim
		const x = (discs[k] - world.x) * scale, y = (world.y - discs[k + 1]) * scale;
		context.moveTo(x + ring * scale, y);
		context.arc(x, y, ring * scale, 0, 2 * Math.PI);
	}
	context.globalAlpha = 0.3;
	context.stroke();
	context.globalAlpha = 1;
}

function drawLines(context, scale, world, lines) {
	context.beginPath();
	for (let k = 0; k < lines.length; k += 4) {
		context.moveTo((lines[k] - world.x) * scale, (world.y - lines[k + 1]) * scale);
		context.lineTo((lines[k + 2] - world.x) * scale, (world.y - lines[k + 3]) * scale);
	}
	context.stroke();
}

// Draws them on a canvas of their own, of the same size; what has none pays for none.
function drawMarks(canvas, below, world, walls, ring, { discs, lines, counts }) {
	canvas.hidden = !walls.length && !ring;
	if (canvas.hidden) return;
	const key = [world.x, world.y, world.width, below.width, below.height, palette().soft].join();
	if (!ring && canvas.dataset.key === key) return;
	canvas.dataset.key = key;
	[canvas.width, canvas.height] = [below.width, below.height];
	const context = canvas.getContext("2d"), scale = below.width / world.width;
	context.translate(below.width / 2, below.height / 2);
	context.strokeStyle = context.fillStyle = `rgb(${palette().soft})`;
	context.lineWidth = Math.max(1, window.devicePixelRatio || 1);
	for (const wall of walls) drawWall(context, scale, world, wall);
	const covered = counts.particles * Math.PI * ring ** 2 / (world.width * world.height);
	if (ring && covered < mostCovered) drawRings(context, scale, world, discs, ring);
	drawLines(context, scale, world, lines);
}
