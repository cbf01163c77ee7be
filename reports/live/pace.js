// How fast pictures come, for whoever wants to know: pictures drawn per second, the longest time between two of the
// browser's frames, and the median and the longest time a frame's script took, in milliseconds, as data of the page.
const pace = (() => {
	const most = 120;
	let drawnInAll = 0, frames = [], pictures = [], scripts = [], longest = 0, work = 0;
	const tell = () => {
		const root = document.documentElement.dataset, script = scripts.slice().sort((a, b) => a - b)[scripts.length >> 1];
		Object.assign(root, { longest: longest.toFixed(1), work: work.toFixed(1), script: script.toFixed(2) });
		root.rate = pictures.length > 1 ? (1000 * (pictures.length - 1) / (pictures.at(-1) - pictures[0])).toFixed(1) : "";
	};
	return {
		drawn: () => drawnInAll,
		restart() {
			[frames, pictures, scripts, longest, work] = [[], [], [], 0, 0];
			Object.assign(document.documentElement.dataset, { longest: 0, work: 0, script: 0, rate: "" });
		},
		note(now, drawn, script) {
			frames.push(now);
			if (frames.length > 60) longest = Math.max(longest, now - frames.at(-2)); // not while all begins
			work = Math.max(work, script);
			if (drawn) {
				drawnInAll++;
				pictures.push(now);
				scripts.push(script);
			}
			for (const list of [frames, pictures, scripts]) if (list.length > most) list.shift();
			if (drawn && drawnInAll % 8 === 0) tell();
		},
	};
})();
