/* What the live page shows: every scene, every method, the failures of the atlas. Usage: page_scenes PROGRAM PAGE, both
 * from the folder worked in, where `cases` is. Exit status 77 where there is no browser. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"

static size_t case_files(void)
{
	glob_t found;
	assert_int_equal(glob("cases/*.yaml", 0, NULL, &found), 0);
	assert_int_equal(glob("cases/stress/*.yaml", GLOB_APPEND, NULL, &found), 0);
	size_t count = found.gl_pathc;
	globfree(&found);
	return count;
}

/* Each scene of the cases is in the page, gets on, and is seen: some pixel is not the paper's. */
static void every_scene_runs(void **state)
{
	(void)state;
	page_show("?paused");
	char *words = page_script("return [...document.getElementById('scene').options].map(each => each.value).join(' ')");
	size_t count = 0;
	char *rest = NULL;
	for (char *scene = strtok_r(words, " ", &rest); scene; scene = strtok_r(NULL, " ", &rest), count++) {
		char query[200];
		snprintf(query, sizeof query, "?scene=%s&length=30&aspect-ratio=1&rate=0.5&draw=2d&speed=2", scene);
		page_show(query);
		page_wait_for("parseInt(document.getElementById('events-0').textContent) > 0");
		assert_true(page_holds("(canvas => new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, "
							   "canvas.height).data.buffer).some((pixel, k, all) => pixel !== all[0]))"
							   "(document.getElementById('canvas-0'))"));
		assert_true(page_holds("document.getElementById('notes').textContent === ''"));
		page_without_errors();
	}
	print_message("%zu scenes\n", count);
	assert_int_equal(count, case_files());
	free(words);
}

/* Without a box the picture follows: three balls that fly apart stay in it. */
static void open_scenes_are_followed(void **state)
{
	(void)state;
	page_show("?scene=three-body&against=naive&rate=10");
	page_wait_for("latest?.views[0].counts.time > 200");
	page_wait_for("document.getElementById('caption-1').textContent.includes('halted')");
	assert_true(page_holds("document.getElementById('failure-1').textContent.startsWith('t =')"));
	assert_true(page_holds("document.getElementById('failure-0').textContent === 'none yet'"));
	assert_true(page_holds("world.width > 100 && world.width < 2000 && [0, 6, 12].every(k => "
						   "Math.abs(latest.views[0].discs[k] - world.x) < world.width / 2)"));
	page_without_errors();
}

/* Steps and walls are drawn over the discs, and where there are none nothing is. */
static void marks_are_drawn_where_there_are_any(void **state)
{
	(void)state;
	static const struct {
		const char *scene;
		bool marked;
	} scenes[] = {{"square-well", true}, {"stress-corner", true}, {"column", true}, {"stress-dense", false}};
	for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
		char query[100];
		snprintf(query, sizeof query, "?scene=%s&speed=3", scenes[s].scene);
		page_show(query);
		page_wait_for("latest");
		page_wait_for("latest.views[0].counts.events > 4");
		if (!scenes[s].marked) {
			assert_true(page_holds("document.getElementById('marks-0').hidden"));
			continue;
		}
		page_wait_for("(canvas => canvas.width > 100 && canvas.getContext('2d').getImageData(0, 0, canvas.width, "
					  "canvas.height).data.some(byte => byte > 0))(document.getElementById('marks-0'))");
	}
	page_show("?scene=square-well&speed=3");
	page_wait_for("latest?.views[0].lines.length > 0");
	page_wait_for("document.getElementById('captured-0').textContent > 0");
	assert_true(page_holds("document.getElementById('look').textContent.includes('distance of 3')"));
	page_without_errors();
}

/* By a graphics card (or software in its place), by pixels and by paths the same discs look alike: the mean colour
 * differs by half a shade of 256 at most, where one without discs is away by ten. */
static void ways_of_drawing_look_alike(void **state)
{
	(void)state;
	static const char *const mean =
		"const canvas = document.createElement('canvas'), gl = canvas.getContext('2d'); "
		"const from = document.getElementById('canvas-0'); "
		"[canvas.width, canvas.height] = [from.width, from.height]; "
		"draw[0](latest.views[0].discs, world); gl.drawImage(from, 0, 0); "
		"const data = gl.getImageData(0, 0, canvas.width, canvas.height).data; "
		"let sum = [0, 0, 0]; data.forEach((byte, k) => k % 4 < 3 && (sum[k % 4] += byte)); "
		"return sum.map(each => each * 4 / data.length).join(' ')";
	static const char *const scenes[] = {"scene=convection&length=40&nitems=300&method=guarded&arithmetic=short:10",
										 "scene=mixture&nitems=400", "scene=stress-dense&arithmetic=short:8"};
	for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
		static const char *const ways[] = {"2d", "webgl"};
		double color[2][3];
		for (int way = 0; way < 2; way++) {
			char query[200];
			snprintf(query, sizeof query, "?%s&aspect-ratio=1&rate=10&speed=2&events=400&draw=%s", scenes[s],
					 ways[way]);
			page_show(query);
			page_wait_for("document.getElementById('pause').textContent === 'Run'");
			page_wait_for("document.getElementById('events-0').textContent === '400'");
			char *text = page_script(mean);
			assert_int_equal(sscanf(text, "%lf %lf %lf", &color[way][0], &color[way][1], &color[way][2]), 3);
			free(text);
		}
		print_message("%s: (%.2f, %.2f, %.2f) and (%.2f, %.2f, %.2f)\n", scenes[s], color[0][0], color[0][1],
					  color[0][2], color[1][0], color[1][1], color[1][2]);
		for (int channel = 0; channel < 3; channel++) {
			assert_true(color[0][channel] < 245);
			assert_float_equal(color[0][channel], color[1][channel], 1.5);
		}
	}
	page_without_errors();
}

/* Each of the page's methods once on the left and once on the right, in the scene where all but the sound ones fail. */
static void every_method_runs(void **state)
{
	(void)state;
	page_show("?paused");
	char *words =
		page_script("return [...document.getElementById('method-0').options].map(each => each.value).join(' ')");
	static const char *const known[] = {"stable", "naive",  "guarded", "compensated", "rewind",
										"skip",   "search", "shrink",  "tc"};
	for (size_t k = 0; k < sizeof known / sizeof *known; k++) assert_non_null(strstr(words, known[k]));
	char *rest = NULL, *left = strtok_r(words, " ", &rest);
	for (char *right; (right = strtok_r(NULL, " ", &rest)); left = right) {
		char query[200], caption[200];
		snprintf(query, sizeof query,
				 "?scene=convection&length=30&aspect-ratio=1&nitems=100&draw=2d&method=%s&against=%s", left, right);
		page_show(query);
		page_wait_for("['events-0', 'events-1'].every(id => parseInt(document.getElementById(id).textContent) > 0)");
		snprintf(caption, sizeof caption,
				 "document.getElementById('caption-0').textContent.startsWith('%s in binary64') && "
				 "document.getElementById('caption-1').textContent.startsWith('%s in binary64')",
				 left, right);
		page_wait_for(caption);
		page_without_errors();
	}
	free(words);
}

/* Addresses as the failure atlas has them show what the program finds there, in each of its scenes. */
static void failures_of_the_atlas_are_shown(void **state)
{
	(void)state;
	static const struct {
		const char *scene, *method, *arithmetic, *events;
	} cells[] = {
		{"near-collapse", "rewind", "binary64", "732"}, {"near-collapse", "stretch", "short:5", "1702"},
		{"cradle", "guarded", "binary64", "2"},         {"column", "guarded", "binary64", "1483"},
		{"grazing", "stable", "short:10", "16"},        {"corner", "naive", "binary64", "62"},
		{"far-away", "nudge", "short:17", "50"},        {"long-times", "last-event", "short:24", "40"},
		{"dilute", "stable", "short:14", "612"},        {"dense", "positional", "short:10", "1003"},
		{"inelastic", "skip", "short:11", "491"},
	};
	for (size_t c = 0; c < sizeof cells / sizeof *cells; c++) {
		char words[200], digest[17], query[200];
		snprintf(words, sizeof words, "stress/%s --method %s --arithmetic %s --events %s", cells[c].scene,
				 cells[c].method, cells[c].arithmetic, cells[c].events);
		page_native_digest(words, digest);
		snprintf(query, sizeof query,
				 "?scene=stress-%s&seed=1&method=%s&arithmetic=%s&against=stable@binary64&events=%s&rate=10&speed=6",
				 cells[c].scene, cells[c].method, cells[c].arithmetic, cells[c].events);
		page_show(query);
		page_wait_for("document.getElementById('pause').textContent === 'Run'");
		snprintf(query, sizeof query, "document.getElementById('digest-0').textContent === '%s'", digest);
		page_wait_for(query);
		assert_true(page_holds("document.getElementById('notes').textContent === ''"));
		page_without_errors();
	}
}

int main(int argc, char **argv)
{
	int status = page_open(argc, argv);
	if (status) return status;
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(every_scene_runs),
		cmocka_unit_test(open_scenes_are_followed),
		cmocka_unit_test(marks_are_drawn_where_there_are_any),
		cmocka_unit_test(ways_of_drawing_look_alike),
		cmocka_unit_test(every_method_runs),
		cmocka_unit_test(failures_of_the_atlas_are_shown),
	};
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	page_close();
	return failed;
}
