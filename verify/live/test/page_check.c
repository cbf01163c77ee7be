/* The live page in a real browser: it loads from disk, does what its address and its controls say, and computes the
 * numbers that the program computes. Usage: page_check PROGRAM PAGE, both from the folder worked in. Exit status 77
 * where there is no browser. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "browser.h"

static struct browser browser;
static const char *program, *page;

static char *script(const char *text)
{
	char *value = browser_script(&browser, text);
	if (value) return value;
	fail_msg("no answer to: %s", text);
	abort(); /* not reached, which compilers do not know */
}

/* Text of an element of the page. */
static char *text_of(const char *id)
{
	char text[200];
	snprintf(text, sizeof text, "return document.getElementById('%s').textContent", id);
	return script(text);
}

static bool holds(const char *condition)
{
	char text[400];
	snprintf(text, sizeof text, "return String(Boolean(%s))", condition);
	char *value = script(text);
	bool yes = strcmp(value, "true") == 0;
	free(value);
	return yes;
}

/* Waits a minute at most, which a loaded machine may need. */
static void wait_for(const char *condition)
{
	for (int wait = 0; wait < 600; wait++) {
		if (holds(condition)) return;
		usleep(100000);
	}
	fail_msg("never came true: %s", condition);
}

static void show(const char *query)
{
	char url[600], *folder = realpath(page, NULL);
	snprintf(url, sizeof url, "file://%s%s", folder, query);
	free(folder);
	assert_true(browser_go(&browser, url));
	wait_for("document.documentElement.dataset.run");
}

static void assert_no_errors(void)
{
	char *errors = browser_errors(&browser);
	if (*errors) fail_msg("on the console: %s", errors);
	free(errors);
}

static void assert_within(const char *part, char *text)
{
	if (!strstr(text, part)) fail_msg("no '%s' in '%s'", part, text);
	free(text);
}

static void loads_from_disk(void **state)
{
	(void)state;
	show("?paused");
	assert_no_errors();
	assert_true(holds("document.getElementById('canvas-0').width > 100"));
	wait_for("document.getElementById('caption-0').textContent.includes('stable in binary64')");
	wait_for("document.getElementById('caption-1').textContent.includes('stable in binary32')");
	char *drawn = script("return document.getElementById('canvas-0').dataset.drawn || ''");
	print_message("drawn by %s\n", drawn);
	assert_true(strcmp(drawn, "webgl2") == 0 || strcmp(drawn, "2d") == 0);
	free(drawn);
}

/* What the program prints of a run. */
static void native_digest(const char *words, char digest[17])
{
	char line[400];
	snprintf(line, sizeof line, "%s run %s --json - | sed -n 's/^ *\"digest\": \"\\([0-9a-f]*\\)\".*/\\1/p'", program,
			 words);
	FILE *pipe = popen(line, "r");
	assert_non_null(pipe);
	assert_int_equal(fread(digest, 1, 16, pipe), 16);
	digest[16] = 0;
	pclose(pipe);
}

static void same_numbers(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:22"};
	show(
		"?scene=convection&length=80&aspect-ratio=1&nitems=1000&seed=7&events=100000&rate=10&speed=6&against=short:22");
	wait_for("document.getElementById('pause').textContent === 'Run'");
	wait_for("['events-0', 'events-1'].every(id => document.getElementById(id).textContent.replace(/\\D/g, '') === "
			 "'100000')");
	for (int p = 0; p < 2; p++) {
		char words[200], digest[17], id[16];
		snprintf(words, sizeof words,
				 "convection --set particles=1000 --set 'box=[80,80]' --seed 7 --events 1e5 --arithmetic %s",
				 arithmetics[p]);
		native_digest(words, digest);
		snprintf(id, sizeof id, "digest-%d", p);
		char *got = text_of(id);
		print_message("%s after 100000 events: %s here, %s in the page\n", arithmetics[p], digest, got);
		assert_string_equal(got, digest);
		free(got);
	}
	assert_no_errors();
}

static void addresses_are_brought_within_bounds(void **state)
{
	(void)state;
	show("?nitems=1e12&length=64&aspect-ratio=1&rate=-1&seed=xyz&paused");
	char *notes = text_of("notes");
	print_message("%s\n", notes);
	assert_non_null(strstr(notes, "packing limited to 40"));
	assert_non_null(strstr(notes, "rate"));
	assert_within("xyz", notes);
	wait_for("location.search.includes('nitems=2086')");
	assert_true(holds("document.getElementById('nitems').value === '2086'"));
	show("?length=1e300&nitems=500&aspect-ratio=0&paused");
	assert_within("length", text_of("notes"));
	show("?scene=nonsense&method=wishful&arithmetic=short:99&against=@@&length=NaN&paused");
	notes = text_of("notes");
	assert_non_null(strstr(notes, "nonsense"));
	assert_non_null(strstr(notes, "wishful"));
	assert_within("short:99", notes);
	assert_true(holds("document.getElementById('canvas-0').width > 100"));
	assert_no_errors();
}

static void precisions_diverge(void **state)
{
	(void)state;
	show("?length=40&aspect-ratio=1&nitems=300&speed=4&method=stable&arithmetic=binary64&against=binary32");
	wait_for("document.getElementById('horizon').dataset.events > 0");
	char *horizon = text_of("horizon");
	print_message("%s\n", horizon);
	free(horizon);
	assert_true(holds("document.getElementById('horizon').dataset.events < 200000"));
	show("?length=40&aspect-ratio=1&nitems=300&rate=10&speed=4&events=20000&against=binary64");
	wait_for("document.getElementById('pause').textContent === 'Run'");
	assert_within("No difference yet", text_of("horizon"));
}

static void controls_do_what_they_say(void **state)
{
	(void)state;
	static const char *const change = "const e = document.getElementById('%s'); e.value = '%s'; e.dispatchEvent(new "
									  "Event('change', {bubbles: true})); return ''";
	char text[300];
	show("?length=40&aspect-ratio=1&nitems=200&seed=3&paused");
	wait_for("document.getElementById('events-0')?.textContent === '0'");
	for (int k = 1; k <= 3; k++) {
		free(script("document.getElementById('step').click(); return ''"));
		snprintf(text, sizeof text, "document.getElementById('events-0').textContent === '%d'", k);
		wait_for(text);
	}
	assert_true(holds("document.querySelectorAll('#log tr').length === 8"));
	free(script("document.getElementById('pause').click(); return ''"));
	wait_for("Number(document.getElementById('events-0').textContent.replace(/\\D/g, '')) > 100");
	free(script("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: ' ', bubbles: true})); return ''"));
	assert_true(holds("document.getElementById('pause').textContent === 'Run'"));
	free(script("document.getElementById('restart').click(); return ''"));
	wait_for("document.getElementById('events-0').textContent === '0'");
	static const char *const changes[][3] = {
		{"seed", "5", "location.search.includes('seed=5')"},
		{"nitems", "150", "document.documentElement.dataset.run === '4' && location.search.includes('nitems=150')"},
		{"method-1", "naive", "document.getElementById('caption-1').textContent.startsWith('naive in binary32')"},
		{"arithmetic-0", "short", "document.getElementById('caption-0').textContent.startsWith('stable in short:16')"},
		{"bits-0", "21", "document.getElementById('caption-0').textContent.startsWith('stable in short:21')"},
		{"arithmetic-1", "none", "document.getElementById('pane-1').hidden"},
		{"scene", "column", "document.getElementById('counts') && location.search.includes('scene=column')"},
	};
	for (size_t c = 0; c < sizeof changes / sizeof *changes; c++) {
		snprintf(text, sizeof text, change, changes[c][0], changes[c][1]);
		free(script(text));
		wait_for(changes[c][2]);
	}
	assert_no_errors();
}

static void every_scene_runs(void **state)
{
	(void)state;
	static const char *const scenes[] = {"convection", "gas", "bouncing-ball", "column", "cradle", "three-body"};
	for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
		char query[200];
		snprintf(query, sizeof query, "?scene=%s&length=30&aspect-ratio=1&nitems=100&rate=0.5&draw=2d&against=naive",
				 scenes[s]);
		show(query);
		wait_for("document.getElementById('events-0').textContent !== '0'");
		assert_no_errors();
	}
	wait_for("document.getElementById('caption-1').textContent.includes('halted')");
	assert_true(holds("document.getElementById('failure-1').textContent.startsWith('t =')"));
	assert_true(holds("document.getElementById('failure-0').textContent === 'none yet'"));
}

/* Each of the page's methods once on the left and once on the right, in the scene where all but the sound ones fail. */
static void every_method_runs(void **state)
{
	(void)state;
	show("?paused");
	char *words = script("return [...document.getElementById('method-0').options].map(each => each.value).join(' ')");
	static const char *const known[] = {"stable", "naive",  "guarded", "compensated", "rewind",
										"skip",   "search", "shrink",  "tc"};
	for (size_t k = 0; k < sizeof known / sizeof *known; k++) assert_non_null(strstr(words, known[k]));
	char *rest = NULL, *left = strtok_r(words, " ", &rest);
	for (char *right; (right = strtok_r(NULL, " ", &rest)); left = right) {
		char query[200], caption[200];
		snprintf(query, sizeof query,
				 "?scene=convection&length=30&aspect-ratio=1&nitems=100&draw=2d&method=%s&against=%s", left, right);
		show(query);
		wait_for("['events-0', 'events-1'].every(id => document.getElementById(id).textContent !== '0')");
		snprintf(caption, sizeof caption,
				 "document.getElementById('caption-0').textContent.startsWith('%s in binary64') && "
				 "document.getElementById('caption-1').textContent.startsWith('%s in binary64')",
				 left, right);
		wait_for(caption);
		assert_no_errors();
	}
	free(words);
}

/* Addresses as the failure atlas has them show what the program finds there. */
static void failures_of_the_atlas_are_shown(void **state)
{
	(void)state;
	static const struct {
		const char *scene, *method, *arithmetic, *events;
	} cells[] = {
		{"near-collapse", "rewind", "binary64", "732"},
		{"cradle", "guarded", "binary64", "2"},
		{"column", "guarded", "binary64", "1483"},
		{"grazing", "stable", "short:10", "16"},
	};
	for (size_t c = 0; c < sizeof cells / sizeof *cells; c++) {
		char words[200], digest[17], query[200];
		snprintf(words, sizeof words, "stress/%s --method %s --arithmetic %s --events %s", cells[c].scene,
				 cells[c].method, cells[c].arithmetic, cells[c].events);
		native_digest(words, digest);
		snprintf(query, sizeof query,
				 "?scene=stress-%s&seed=1&method=%s&arithmetic=%s&against=stable@binary64&events=%s&rate=10&speed=6",
				 cells[c].scene, cells[c].method, cells[c].arithmetic, cells[c].events);
		show(query);
		wait_for("document.getElementById('pause').textContent === 'Run'");
		snprintf(query, sizeof query, "document.getElementById('digest-0').textContent === '%s'", digest);
		wait_for(query);
		assert_true(holds("document.getElementById('notes').textContent === ''"));
		assert_no_errors();
	}
}

/* Only where nothing else keeps the machine busy: the browser draws without a graphics card here. */
static void frames_come_in_time(void **state)
{
	(void)state;
	double load[1] = {0};
	getloadavg(load, 1);
	if (load[0] >= 1) {
		print_message("a load of %.1f: frames are not looked at\n", load[0]);
		skip();
	}
	show("?aspect-ratio=1.6");
	sleep(3);
	char *work = script("return document.documentElement.dataset.work"), *rate = script("return "
																						"document.documentElement."
																						"dataset.rate");
	char *longest = script("return document.documentElement.dataset.longest");
	print_message("load %.1f: longest script of a frame %s ms, longest between frames %s ms, %s frames a second\n",
				  load[0], work, longest, rate);
	assert_true(atof(work) < 100);
	free(work);
	free(rate);
	free(longest);
}

int main(int argc, char **argv)
{
	char error[200];
	if (argc != 3) {
		fprintf(stderr, "page_check: accepted: PROGRAM PAGE\n");
		return 2;
	}
	program = argv[1], page = argv[2];
	if (!browser_open(&browser, 900, 800, error)) {
		fprintf(stderr, "page_check: skipped: %s\n", error);
		return 77;
	}
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(loads_from_disk),
		cmocka_unit_test(same_numbers),
		cmocka_unit_test(addresses_are_brought_within_bounds),
		cmocka_unit_test(precisions_diverge),
		cmocka_unit_test(controls_do_what_they_say),
		cmocka_unit_test(every_scene_runs),
		cmocka_unit_test(every_method_runs),
		cmocka_unit_test(failures_of_the_atlas_are_shown),
		cmocka_unit_test(frames_come_in_time),
	};
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	browser_close(&browser);
	return failed;
}
