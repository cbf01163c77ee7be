// Discs by WebGL2: all of them in one call, from a texture.
const discsPerRow = 256, texelsPerDisc = floatsPerDisc / 2;

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

// Writes discs into the texture: its whole rows, then the last one as far as it goes.
function upload(gl, discs, rows) {
	const count = discs.length / floatsPerDisc, whole = Math.floor(count / discsPerRow), rest = count % discsPerRow;
	const width = texelsPerDisc * discsPerRow;
	if (rows < whole + 1) {
		rows = 2 * (whole + 1);
		gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG32F, width, rows, 0, gl.RG, gl.FLOAT, null);
	}
	const write = (row, wide, high, from) => gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, wide, high, gl.RG, gl.FLOAT, discs, from);
	if (whole) write(0, width, whole, 0);
	if (rest) write(whole, texelsPerDisc * rest, 1, whole * discsPerRow * floatsPerDisc);
	return rows;
}

function drawByCard(canvas, gl) {
	const program = compile(gl), uniforms = {};
	for (const name of ["per_row", "centre", "half_view", "pixel", "cold", "mild", "hot", "sheet"])
		uniforms[name] = gl.getUniformLocation(program, name);
	gl.useProgram(program);
	gl.uniform1i(uniforms.per_row, discsPerRow);
	gl.enable(gl.BLEND);
	gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
	gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
	gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
	gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
	let rows = 0, shown;
	return (discs, world) => {
		if (shown !== palette()) {
			shown = palette();
			for (const name of ["cold", "mild", "hot", "sheet"]) gl.uniform3fv(uniforms[name], shown[name].map(channel => channel / 255));
			gl.clearColor(...shown.sheet.map(channel => channel / 255), 1);
		}
		gl.viewport(0, 0, canvas.width, canvas.height);
		gl.clear(gl.COLOR_BUFFER_BIT);
		rows = upload(gl, discs, rows);
		gl.uniform2f(uniforms.centre, world.x, world.y);
		gl.uniform2f(uniforms.half_view, world.width / 2, world.height / 2);
		gl.uniform1f(uniforms.pixel, world.width / canvas.width);
		gl.drawArrays(gl.TRIANGLES, 0, 6 * discs.length / floatsPerDisc);
	};
}
