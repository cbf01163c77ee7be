/* The live page in a real browser: it loads from disk, does what its address and its controls say, and computes the
 * numbers that the program computes. Usage: page_check PROGRAM PAGE, both from the folder worked in. Exit status 77
 * where there is no browser. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "page.h"

static void assert_within(const char *part, char *text)
{
	if (!strstr(text, part)) fail_msg("no '%s' in '%s'", part, text);
	free(text);
}

static void loads_from_disk(void **state)
{
	(void)state;
	page_show("?paused");
	page_without_errors();
	assert_true(page_holds("document.getElementById('canvas-0').width > 100"));
	page_wait_for("document.getElementById('caption-0').textContent.includes('stable in binary64')");
	page_wait_for("document.getElementById('caption-1').textContent.includes('stable in binary32')");
	char *drawn = page_script("return document.getElementById('canvas-0').dataset.drawn || ''");
	print_message("drawn by %s\n", drawn);
	assert_true(strcmp(drawn, "webgl2") == 0 || strcmp(drawn, "2d") == 0);
	free(drawn);
}

static void same_numbers(void **state)
{
	(void)state;
	static const char *const arithmetics[] = {"binary64", "short:22"};
	page_show(
		"?scene=convection&length=80&aspect-ratio=1&nitems=1000&seed=7&events=100000&rate=10&speed=6&against=short:22");
	page_wait_for("document.getElementById('pause').textContent === 'Run'");
	page_wait_for(
		"['events-0', 'events-1'].every(id => document.getElementById(id).textContent.replace(/\\D/g, '') === "
		"'100000')");
	for (int p = 0; p < 2; p++) {
		char words[200], digest[17], id[16];
		snprintf(words, sizeof words,
				 "convection --set particles=1000 --set 'box=[80,80]' --seed 7 --events 1e5 --arithmetic %s",
				 arithmetics[p]);
		page_native_digest(words, digest);
		snprintf(id, sizeof id, "digest-%d", p);
		char *got = page_text(id);
		print_message("%s after 100000 events: %s here, %s in the page\n", arithmetics[p], digest, got);
		assert_string_equal(got, digest);
		free(got);
	}
	page_without_errors();
}

static void addresses_are_brought_within_bounds(void **state)
{
	(void)state;
	page_show("?nitems=1e12&length=64&aspect-ratio=1&rate=-1&seed=xyz&paused");
	char *notes = page_text("notes");
	print_message("%s\n", notes);
	assert_non_null(strstr(notes, "packing limited to 40"));
	assert_non_null(strstr(notes, "rate"));
	assert_within("xyz", notes);
	page_wait_for("location.search.includes('nitems=2086')");
	assert_true(page_holds("document.getElementById('nitems').value === '2086'"));
	page_show("?length=1e300&nitems=500&aspect-ratio=0&paused");
	assert_within("length", page_text("notes"));
	page_show("?scene=nonsense&method=wishful&arithmetic=short:99&against=@@&length=NaN&paused");
	notes = page_text("notes");
	assert_non_null(strstr(notes, "nonsense"));
	assert_non_null(strstr(notes, "wishful"));
	assert_within("short:99", notes);
	assert_true(page_holds("document.getElementById('canvas-0').width > 100"));
	page_without_errors();
}

static void precisions_diverge(void **state)
{
	(void)state;
	page_show("?length=40&aspect-ratio=1&nitems=300&speed=4&method=stable&arithmetic=binary64&against=binary32");
	page_wait_for("document.getElementById('horizon').dataset.events > 0");
	char *horizon = page_text("horizon");
	print_message("%s\n", horizon);
	free(horizon);
	assert_true(page_holds("document.getElementById('horizon').dataset.events < 200000"));
	page_show("?length=40&aspect-ratio=1&nitems=300&rate=10&speed=4&events=20000&against=binary64");
	page_wait_for("document.getElementById('pause').textContent === 'Run'");
	assert_within("No difference yet", page_text("horizon"));
}

static void controls_do_what_they_say(void **state)
{
	(void)state;
	static const char *const change = "const e = document.getElementById('%s'); e.value = '%s'; e.dispatchEvent(new "
									  "Event('change', {bubbles: true})); return ''";
	char text[300];
	page_show("?length=40&aspect-ratio=1&nitems=200&seed=3&paused");
	page_wait_for("document.getElementById('events-0')?.textContent === '0'");
	for (int k = 1; k <= 3; k++) {
		free(page_script("document.getElementById('step').click(); return ''"));
		snprintf(text, sizeof text, "document.getElementById('events-0').textContent === '%d'", k);
		page_wait_for(text);
	}
	assert_true(page_holds("document.querySelectorAll('#log tr').length === 8"));
	free(page_script("document.getElementById('pause').click(); return ''"));
	page_wait_for("Number(document.getElementById('events-0').textContent.replace(/\\D/g, '')) > 100");
	free(
		page_script("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: ' ', bubbles: true})); return ''"));
	assert_true(page_holds("document.getElementById('pause').textContent === 'Run'"));
	free(page_script("document.getElementById('restart').click(); return ''"));
	page_wait_for("document.getElementById('events-0').textContent === '0'");
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
		free(page_script(text));
		page_wait_for(changes[c][2]);
	}
	page_without_errors();
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
	page_show("?aspect-ratio=1.6");
	sleep(3);
	char *work = page_script("return document.documentElement.dataset.work"),
		 *rate = page_script("return "
							 "document.documentElement."
							 "dataset.rate");
	char *longest = page_script("return document.documentElement.dataset.longest");
	print_message("load %.1f: longest script of a frame %s ms, longest between frames %s ms, %s frames a second\n",
				  load[0], work, longest, rate);
	assert_true(atof(work) < 100);
	free(work);
	free(rate);
	free(longest);
}

int main(int argc, char **argv)
{
	int status = page_open(argc, argv);
	if (status) return status;
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(loads_from_disk),
		cmocka_unit_test(same_numbers),
		cmocka_unit_test(addresses_are_brought_within_bounds),
		cmocka_unit_test(precisions_diverge),
		cmocka_unit_test(controls_do_what_they_say),
		cmocka_unit_test(frames_come_in_time),
	};
	int failed = cmocka_run_group_tests(tests, NULL, NULL);
	page_close();
	return failed;
}
