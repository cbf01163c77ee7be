/* `touchstone campaign` and `touchstone merge`, as a user meets them: the same numbers from threads and shards. */
#include "campaign/piece_store.h"
#include "campaign_samples.h"

static void threads_shards_and_merges_agree(void **state)
{
	(void)state;
	static const int order[][3] = {{1, 2, 3}, {3, 1, 2}};
	for (int way = 0; way < 2; way++) {
		char name[20], path[200];
		snprintf(name, sizeof name, "shards%d", way);
		for (int s = 0; s < 3; s++) {
			struct said said = program_run("campaign %s/small.yaml --results %s/%s --shard %d/3 --threads %d", folder,
										   folder, name, order[way][s], 1 + way);
			if (said.status != 0 || !strstr(said.err, "4 of 4 runs")) fail_msg("%s%s", said.out, said.err);
			said_free(&said);
		}
		snprintf(path, sizeof path, "%s/%s/small", folder, name);
		for (int again = 0; again < 2; again++) {
			struct said said =
				program_run("merge %s.pieces %s-%d-of-3.pieces %s-%d-of-3.pieces %s-%d-of-3.pieces", path, path,
							order[1 - way][0], path, order[1 - way][1], path, order[1 - way][2]);
			assert_int_equal(said.status, 0);
			if (!strstr(said.out, again ? "12 pieces, 0 of them new" : "12 pieces, 12 of them new"))
				fail_msg("%s", said.out);
			said_free(&said);
		}
		char *merged = folder_text(folder, way ? "shards1/small.pieces" : "shards0/small.pieces");
		json_t *runs = finish(name, "small");
		char *after = folder_text(folder, way ? "shards1/small.pieces" : "shards0/small.pieces");
		assert_string_equal(merged, after); /* nothing was left to make */
		assert_true(json_equal(runs, expected));
		struct said said = program_run("campaign %s/small.yaml --results %s/%s --shard 1/5", folder, folder, name);
		assert_non_null(strstr(said.err, "0 of 0 runs")); /* nor for a shard of another size */
		said_free(&said);
		json_decref(runs);
		free(merged);
		free(after);
	}
}

static void pieces_are_what_run_tells(void **state)
{
	(void)state;
	assert_int_equal(json_array_size(expected), RUNS);
	const json_t *last = json_array_get(expected, RUNS - 1);
	json_t *run = program_json(program_run("run square-well --set particles=32 --set start.temperature=2 --events 1e3 "
										   "--set equilibrate=5 --set density=0.4 --arithmetic short:12 --seed 7 "
										   "--measure impact,conservation,three-body,failure,states "
										   "--against mpfr:100 --json -"),
							   0);
	static const char *const same[] = {"digest",  "seed",   "arithmetic", "impact",  "conservation", "three_body",
									   "failure", "states", "horizon",    "parting", "events",       "verdict"};
	for (size_t s = 0; s < sizeof same / sizeof *same; s++)
		if (!json_object_get(run, same[s]) ||
			!json_equal(json_object_get(run, same[s]), json_object_get(last, same[s])))
			fail_msg("%s differs", same[s]);
	assert_string_equal(json_text(json_object_get(last, "point"), "arithmetic"), "short:12");
	json_decref(run);
}

/* Mean, deviation and count of a point are those of its rows. */
static void tables_hold_what_runs_tell(void **state)
{
	(void)state;
	json_t *runs = finish("tables", "small");
	char *table = folder_text(folder, "tables/small-runs.csv"),
		 *points = folder_text(folder, "tables/small-points.csv");
	assert_int_equal(program_lines(table), 1 + RUNS);
	assert_int_equal(program_lines(points), 1 + 4);
	double time[3], mean = 0;
	for (size_t s = 0; s < 3; s++) mean += (time[s] = json_number(json_array_get(runs, 3 + s), "time")) / 3;
	size_t column = 0, at = 0;
	char *rest, *line = strtok_r(points, "\n", &rest);
	for (char *cell, *cells = line; (cell = strsep(&cells, ",")); at++)
		if (strcmp(cell, "time") == 0) column = at;
	line = strtok_r(NULL, "\n", &rest), line = strtok_r(NULL, "\n", &rest); /* density 0.2, short:12 */
	assert_int_equal(strncmp(line, "0.2,short:12,3,3,0,0,0,3,0,", 27), 0);
	double told[3];
	for (at = 0; at < column + 3; at++) {
		char *cell = strsep(&line, ",");
		if (at >= column) told[at - column] = atof(cell);
	}
	double squares = 0;
	for (int s = 0; s < 3; s++) squares += (time[s] - mean) * (time[s] - mean) / 2;
	assert_true(told[0] / mean > 1 - 1e-12 && told[0] / mean < 1 + 1e-12);
	assert_true(told[1] * told[1] / squares > 1 - 1e-9 && told[1] * told[1] / squares < 1 + 1e-9);
	assert_true(told[2] == 3);
	json_decref(runs);
	free(table);
	free(points);
	struct said said = program_run("report --results %s/tables --output %s/page", folder, folder);
	if (said.status != 0) fail_msg("%s", said.err);
	said_free(&said);
}

/* A run in so few bits gains energy, whatever its verdict. */
static void failures_are_findings(void **state)
{
	(void)state;
	folder_put(folder, "fails.yaml",
			   "scene: hard-spheres\nset: {particles: 108, method: rewind, arithmetic: 'short:8', equilibrate: 5}\n"
			   "events: 2000\nmeasures: [failure]\n");
	struct said said = program_run("campaign %s/fails.yaml --results %s/fails", folder, folder);
	char *table = folder_text(folder, "fails/fails-runs.csv");
	if (said.status != 1 || !strstr(table, "gains energy")) fail_msg("status %d: %s%s", said.status, table, said.err);
	assert_int_equal(strncmp(table, "seed,verdict,digest,failure,", 28), 0);
	assert_non_null(strstr(said.out, "survived"));
	free(table);
	said_free(&said);
}

static void bad_campaigns_have_a_line(void **state)
{
	(void)state;
	static const struct {
		const char *text, *words;
	} wrong[] = {
		{"", "bad.yaml:1: empty"},
		{"scene: hard-spheres\nspeed: 3\n", "bad.yaml:2: unknown key 'speed'; accepted: title"},
		{"seeds: 1..3\n", "bad.yaml:1: scene: not given"},
		{"scene: nowhere\n", "bad.yaml:1: scene: 'nowhere': no such file"},
		{"scene: hard-spheres\nevents: many\n", "bad.yaml:2: events: events: 'many'"},
		{"scene: hard-spheres\nset: {seed: 3}\n", "bad.yaml:2: set: has a seed; accepted: in `seeds`"},
		{"scene: hard-spheres\nset: {particles: 0}\n", "bad.yaml:2: set.particles: particles: '0'"},
		{"scene: hard-spheres\ngrid:\n  density: 0.5\n", "bad.yaml:3: grid.density: no list of values"},
		{"scene: hard-spheres\ngrid:\n  density: [0.5,\n     -1]\n", "bad.yaml:4: grid.density[1]: density: '-1'"},
		{"scene: hard-spheres\ngrid:\n  density: [0.5, 0.5]\n", "bad.yaml:3: grid.density: '0.5' is there twice"},
		{"scene: hard-spheres\ngrid:\n  colour: [red]\n", "bad.yaml:3: grid.colour[0]: unknown key 'colour'"},
		{"scene: hard-spheres\ngrid:\n  method: [stable,\n    magic]\n", "bad.yaml:4: grid.method[1]: "},
		{"scene: hard-spheres\nseeds: 3..1\n", "bad.yaml:2: seeds: '3..1'; accepted: whole numbers"},
		{"scene: hard-spheres\nseeds: [1, 1]\n", "bad.yaml:2: seeds: 1 is there twice"},
		{"scene: hard-spheres\nseeds: [1..900000, 900000]\n", "bad.yaml:2: seeds: 900000 is there twice"},
		{"scene: hard-spheres\nseeds: 1..1e9\n", "bad.yaml:2: seeds: makes more than 1000000 runs"},
		{"scene: hard-spheres\nmeasures: [impact,\n  speed]\n", "bad.yaml:3: measures[1]: 'speed' is unknown"},
		{"scene: hard-spheres\nevents: 9\nagainst: binary32\n", "bad.yaml:3: against: "},
		{"scene: hard-spheres\ngrid: &a {density: [*a]}\n", "bad.yaml:1: YAML alias unsupported"},
		{"scene: hard-spheres\ngrid: {density: [[[[[[[[[[1]]]]]]]]]]}\n", "density: more than can be said on one line"},
		{"scene: [hard-spheres\n", "not YAML"},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
		folder_put(folder, "bad.yaml", wrong[w].text);
		program_refused(program_run("campaign %s/bad.yaml --results %s/bad", folder, folder), wrong[w].words);
	}
	assert_int_equal(folder_count(folder, "bad"), 1); /* no results */
	program_refused(program_run("campaign none"), "none: no such file, nor in ");
	program_refused(program_run("campaign"), "no campaign");
	program_refused(program_run("campaign a b"), "a second campaign");
	program_refused(program_run("campaign a --shard 5/4"), "--shard: '5/4'");
	program_refused(program_run("campaign %s/small.yaml --shard 1/4 --json -", folder), "--json");
	program_refused(program_run("merge one"), "nothing to merge");
	program_refused(program_run("merge %s/out.pieces %s/bad.yaml", folder, folder), "bad.yaml: ");
	folder_put(folder, "new.pieces", "");
	struct said said = program_run("merge %s/out.pieces %s/new.pieces", folder, folder);
	assert_int_equal(said.status, 2);
	assert_non_null(strstr(said.err, "none of these stores has a first line yet"));
	said_free(&said);
	assert_int_equal(folder_count(folder, "out.pieces"), 0);
}

static void contradictions_are_findings(void **state)
{
	(void)state;
	for (int store = 0; store < 2; store++) {
		json_t *lines[] = {
			piece_store_head("c"), json_pack("{s:s, s:s, s:{s:i}}", "key", "a", "revision", "r", "result", "n", store),
			json_pack("{s:s, s:s, s:{s:i}}", "key", store ? "b" : "c", "revision", "r", "result", "n", 5)};
		char *text = NULL, name[20];
		size_t length;
		FILE *stream = open_memstream(&text, &length);
		for (int l = 0; l < 3; l++) {
			char *line = piece_store_line(lines[l]);
			fputs(line, stream);
			free(line);
			json_decref(lines[l]);
		}
		fclose(stream);
		snprintf(name, sizeof name, "c%d.pieces", store);
		folder_put(folder, name, text);
		free(text);
	}
	struct said said = program_run("merge %s/c.pieces %s/c0.pieces %s/c1.pieces", folder, folder, folder);
	assert_int_equal(said.status, 1);
	assert_non_null(strstr(said.err, "contradict each other: a"));
	assert_non_null(strstr(said.out, "2 pieces, 2 of them new; 1 contradicted and not taken over"));
	said_free(&said);
	said = program_run("merge %s/c0.pieces %s/c1.pieces", folder, folder); /* one that has it keeps it */
	assert_int_equal(said.status, 1);
	assert_non_null(strstr(said.out, "3 pieces, 1 of them new"));
	said_free(&said);
	folder_put(folder, "new.pieces", ""); /* of a shard that was killed before it had written anything */
	said = program_run("merge %s/d.pieces %s/new.pieces %s/c1.pieces", folder, folder, folder);
	assert_int_equal(said.status, 0);
	assert_non_null(strstr(said.out, "2 pieces, 2 of them new"));
	said_free(&said);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(threads_shards_and_merges_agree), cmocka_unit_test(pieces_are_what_run_tells),
		cmocka_unit_test(tables_hold_what_runs_tell),      cmocka_unit_test(bad_campaigns_have_a_line),
		cmocka_unit_test(contradictions_are_findings),     cmocka_unit_test(failures_are_findings),
	};
	return cmocka_run_group_tests(tests, set_up, tear_down);
}
