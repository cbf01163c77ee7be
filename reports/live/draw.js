// Discs on a canvas: by WebGL2, all at once, or where there is none by an ordinary canvas.
const floatsPerDisc = 5;

function palette() {
	const style = getComputedStyle(document.documentElement);
	return ["cold", "mild", "hot", "sheet"].map(name => style.getPropertyValue("--" + name).trim());
}

function channels(color) {
	return [1, 3, 5].map(k => parseInt(color.slice(k, k + 2), 16) / 255);
}

function compile(gl) {
	const program = gl.createProgram();
	for (const [kind, id] of [[gl.VERTEX_SHADER, "vertex"], [gl.FRAGMENT_SHADER, "fragment"]]) {
		const shader = gl.createShader(kind);
		gl.shaderSource(shader, document.getElementById(id).textContent.trimStart());
		gl.compileShader(shader);
		if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
		gl.attachShader(program, shader);
	}
	gl.linkProgram(program);
	return program;
}

function drawByGpu(canvas, gl) {
	const program = compile(gl), buffer = gl.createBuffer();
	const place = name => gl.getUniformLocation(program, name);
	const uniforms = Object.fromEntries(["half_box", "shift", "pixel", "cold", "mild", "hot"].map(name => [name, place(name)]));
	gl.useProgram(program);
	gl.enable(gl.BLEND);
	gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
	gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
	for (const [name, size, offset] of [["disc", 4, 0], ["depth", 1, 16]]) {
		const attribute = gl.getAttribLocation(program, name);
		gl.enableVertexAttribArray(attribute);
		gl.vertexAttribPointer(attribute, size, gl.FLOAT, false, 4 * floatsPerDisc, offset);
		gl.vertexAttribDivisor(attribute, 1);
	}
	return (discs, world) => {
		const [cold, mild, hot] = palette();
		gl.viewport(0, 0, canvas.width, canvas.height);
		gl.clearColor(0, 0, 0, 0);
		gl.clear(gl.COLOR_BUFFER_BIT);
		gl.bufferData(gl.ARRAY_BUFFER, discs, gl.DYNAMIC_DRAW);
		gl.uniform2f(uniforms.half_box, world.width / 2, world.height / 2);
		gl.uniform1f(uniforms.pixel, world.width / canvas.width);
		gl.uniform3fv(uniforms.cold, channels(cold));
		gl.uniform3fv(uniforms.mild, channels(mild));
		gl.uniform3fv(uniforms.hot, channels(hot));
		for (const shift of world.periodic ? [0, -world.width, world.width] : [0]) { // ghosts across the seam
			gl.uniform1f(uniforms.shift, shift);
			gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, discs.length / floatsPerDisc);
		}
	};
}

function mixed(from, to, part) {
	const [a, b] = [channels(from), channels(to)];
	return `rgb(${a.map((channel, k) => Math.round(255 * (channel + (b[k] - channel) * part)))})`;
}

function drawByHand(canvas) {
	const context = canvas.getContext("2d");
	return (discs, world) => {
		const [cold, mild, hot] = palette(), scale = canvas.width / world.width;
		const shades = Array.from({ length: 17 }, (_, k) => k < 8 ? mixed(cold, mild, k / 8) : mixed(mild, hot, (k - 8) / 8));
		context.clearRect(0, 0, canvas.width, canvas.height);
		const disc = (x, y, radius, color) => {
			context.fillStyle = color;
			context.beginPath();
			context.arc(x, y, radius, 0, 2 * Math.PI);
			context.fill();
		};
		for (let k = 0; k < discs.length; k += floatsPerDisc) {
			const [x, y, radius, warmth, depth] = discs.subarray(k, k + floatsPerDisc);
			const level = Math.min(Math.max((Math.log10(depth) + 7) / 6, 0), 1);
			const color = depth > 0 ? mixed("#ffc700", "#db00b8", level) : shades[Math.round(16 * warmth)];
			const wide = depth > 0 ? Math.max(radius * scale * 1.3, 4) : Math.max(radius * scale, 0.75);
			const px = (x + world.width / 2) * scale, py = canvas.height - (y + world.height / 2) * scale;
			disc(px, py, wide, color);
			if (!world.periodic) continue;
			if (px < wide) disc(px + canvas.width, py, wide, color);
			if (px > canvas.width - wide) disc(px - canvas.width, py, wide, color);
		}
	};
}

// What draws on a canvas: a function of discs and world, {width, height, periodic}.
function drawer(canvas, plain) {
	const gl = plain ? null : canvas.getContext("webgl2", { antialias: false, premultipliedAlpha: true });
	canvas.dataset.drawn = gl ? "webgl2" : "2d";
	return gl ? drawByGpu(canvas, gl) : drawByHand(canvas);
}

// As many pixels as the screen has for it.
function fit(canvas) {
	const density = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
	const width = Math.max(1, Math.round(box.width * density)), height = Math.max(1, Math.round(box.height * density));
	if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
}
