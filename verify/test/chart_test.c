/* The chart: the frontier, the bits of answers, and the command as a user meets it. No time is asserted. */
#include <math.h>
#include <mpfr.h>
#include <signal.h>

#include "family/family.h"
#include "measure/finder_bits.h"
#include "measure/frontier.h"
#include "program.h"
#include "scene/random.h"
#include "touchstone.h"

enum { SEED = 20141015 };

static char *folder; /* for this program's files */
static char error[160];

/* ---- the frontier */

/* From left to right, the best are those that are worth more than all before: found by sorting instead. */
static void the_frontier_is_a_rising_staircase(void **state)
{
	(void)state;
	enum { MOST = 40 };
	struct random_state random = random_seed(SEED);
	for (int draw = 0; draw < 3000; draw++) {
		struct frontier_point points[MOST];
		size_t count = 1 + random_below(&random, MOST), best = 0;
		for (size_t p = 0; p < count; p++) {
			double cost = (double)random_below(&random, 12), worth = (double)random_below(&random, 12);
			bool missing = random_below(&random, 20) == 0, exact = random_below(&random, 20) == 0;
			points[p] = (struct frontier_point){missing ? NAN : cost, exact ? INFINITY : worth, draw % 2};
		}
		frontier_find(points, count);
		for (size_t p = 0; p < count; p++) {
			double highest = -INFINITY, beside = -INFINITY; /* of what costs less, and of what costs the same */
			for (size_t q = 0; q < count; q++) {
				if (points[q].cost < points[p].cost) highest = fmax(highest, points[q].worth);
				if (points[q].cost == points[p].cost) beside = fmax(beside, points[q].worth);
			}
			bool expected = !isnan(points[p].cost) && points[p].worth > highest && points[p].worth == beside;
			if (points[p].best != expected)
				fail_msg("draw %d: (%g, %g) is %sbest", draw, points[p].cost, points[p].worth,
						 points[p].best ? "" : "not ");
			best += points[p].best;
		}
		assert_true(best > 0 || count < 3);
	}
	struct frontier_point missing[2] = {{NAN, 1, true}, {1, NAN, true}};
	frontier_find(missing, 2);
	assert_false(missing[0].best || missing[1].best);
}

/* ---- bits */

enum { QUESTIONS = 200 };
typedef double question[TOUCHSTONE_MOST_NUMBERS];

static const char *const arithmetics[] = {"short:12",  "binary32", "binary64", "extended", "twin",
										  "binary128", "mpfr:53",  "mpfr:113", "mpfr:400"};
enum { ARITHMETICS = sizeof arithmetics / sizeof *arithmetics };

static void draw_questions(const char *family, question number[QUESTIONS])
{
	if (!family_fill(family_named(family), TOUCHSTONE_BALL_BALL, SEED, 0, QUESTIONS, number, error))
		fail_msg("%s", error);
}

/* Unrounded answers, rounded to double, are the answers; they carry no more bits than their arithmetic. */
static void unrounded_answers_round_to_the_answers(void **state)
{
	(void)state;
	static const char *const families[] = {"dense", "grazing", "zeros", "any-doubles"};
	static double terms[QUESTIONS][TOUCHSTONE_MOST_TERMS], times[QUESTIONS];
	static const int bits[ARITHMETICS] = {12, 24, 53, 64, 0, 113, 53, 113, 400};
	question number[QUESTIONS];
	mpfr_t sum;
	mpfr_init2(sum, 1400);
	for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
		draw_questions(families[f], number);
		for (int a = 0; a < ARITHMETICS; a++) {
			assert_true(touchstone_find(arithmetics[a], "stable", TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS,
										false, times, error));
			assert_true(touchstone_find_terms(arithmetics[a], "stable", TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS,
											  terms, error));
			for (int k = 0; k < QUESTIONS; k++) {
				bool both_nan = isnan(times[k]) && isnan(terms[k][0]);
				if (!both_nan && terms[k][0] != times[k])
					fail_msg("%s, %s: %a, not %a", families[f], arithmetics[a], terms[k][0], times[k]);
				mpfr_set_zero(sum, 1);
				for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++)
					mpfr_add_d(sum, sum, terms[k][term], MPFR_RNDN);
				if (bits[a] && mpfr_number_p(sum)) assert_true(mpfr_min_prec(sum) <= bits[a]);
			}
		}
	}
	mpfr_clear(sum);
	assert_false(touchstone_find_terms("decimal", "stable", TOUCHSTONE_BALL_BALL, NULL, 0, NULL, error));
	assert_false(touchstone_find_terms("binary64", "kahan", TOUCHSTONE_HALF_SPACE, NULL, 0, NULL, error));
}

/* The same by another way: bits of one answer from 2000 bits of MPFR, by the definition. */
static double slow_bits(const double *answer, const question number)
{
	enum { ENOUGH = 2000 };
	mpfr_t a, b, c, x, d;
	mpfr_inits2(ENOUGH, a, b, c, x, d, (mpfr_ptr)0);
	mpfr_set_d(c, -number[6], MPFR_RNDN);
	mpfr_mul_d(c, c, number[6], MPFR_RNDN);
	mpfr_set_zero(a, 1), mpfr_set_zero(b, 1);
	for (int axis = 0; axis < 3; axis++) {
		const double r = number[axis], v = number[3 + axis];
		mpfr_set_d(x, v, MPFR_RNDN), mpfr_mul_d(x, x, v, MPFR_RNDN), mpfr_add(a, a, x, MPFR_RNDN);
		mpfr_set_d(x, v, MPFR_RNDN), mpfr_mul_d(x, x, r, MPFR_RNDN), mpfr_add(b, b, x, MPFR_RNDN);
		mpfr_set_d(x, r, MPFR_RNDN), mpfr_mul_d(x, x, r, MPFR_RNDN), mpfr_add(c, c, x, MPFR_RNDN);
	}
	mpfr_sqr(d, b, MPFR_RNDN), mpfr_mul(x, a, c, MPFR_RNDN), mpfr_sub(d, d, x, MPFR_RNDN);
	mpfr_sqrt(d, d, MPFR_RNDN), mpfr_sub(d, d, b, MPFR_RNDN), mpfr_div(d, c, d, MPFR_RNDN); /* the exact time */
	mpfr_set_zero(x, 1);
	for (int term = 0; term < TOUCHSTONE_MOST_TERMS; term++) mpfr_add_d(x, x, answer[term], MPFR_RNDN);
	mpfr_max(a, x, d, MPFR_RNDN), mpfr_sub(x, x, d, MPFR_RNDN), mpfr_abs(x, x, MPFR_RNDN), mpfr_div(x, x, a, MPFR_RNDN);
	bool exact = mpfr_zero_p(x);
	mpfr_log2(x, x, MPFR_RNDN);
	double bits = exact ? INFINITY : fmax(0, -mpfr_get_d(x, MPFR_RNDN));
	mpfr_clears(a, b, c, x, d, (mpfr_ptr)0);
	return bits;
}

static void bits_are_those_of_the_definition(void **state)
{
	(void)state;
	struct oracle *oracle = oracle_create();
	struct finder_truth *truth = finder_truth_create(QUESTIONS, 400);
	struct finder_bits *bits = calloc(1, sizeof *bits);
	static double terms[QUESTIONS][TOUCHSTONE_MOST_TERMS];
	question number[QUESTIONS];
	assert_true(oracle && truth && bits);
	draw_questions("dense", number);
	for (int a = 0; a < ARITHMETICS; a++) {
		double least = INFINITY, before = -1;
		size_t found = 0;
		finder_bits_begin(bits);
		assert_true(isnan(finder_bits_of_share(bits, 0.5)));
		finder_truth_solve(truth, oracle, TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS);
		assert_true(finder_bits_add(bits, truth, oracle, arithmetics[a], "stable", error));
		touchstone_find_terms(arithmetics[a], "stable", TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS, terms, error);
		for (int k = 0; k < QUESTIONS; k++) {
			struct oracle_query query = {.shape = ORACLE_BALL_BALL};
			memcpy(query.number, number[k], sizeof query.number);
			if (oracle_solve(oracle, &query).event != ORACLE_LATER || terms[k][0] == INFINITY) continue;
			least = fmin(least, slow_bits(terms[k], number[k]));
			found++;
		}
		assert_int_equal(bits->found, found);
		assert_true(found > 10);
		if (!(fabs(bits->least - least) < 1e-6))
			fail_msg("%s: %.9g bits, not %.9g", arithmetics[a], bits->least, least);
		for (double share = 1; share > 0.05; share -= 0.1) { /* fewer answers, more bits */
			double now = finder_bits_of_share(bits, share);
			assert_true(now >= before && now >= least - 1e-6);
			before = now;
		}
		assert_true(fabs(finder_bits_of_share(bits, 1) - least) <= 1.0 / FINDER_BITS_STEP);
	}
	free(bits);
	finder_truth_destroy(truth);
	oracle_destroy(oracle);
}

/* Correct rounding in P bits is right to P bits, whatever the question. */
static void correct_rounding_has_all_its_bits(void **state)
{
	(void)state;
	static const struct {
		const char *arithmetic;
		int bits;
	} exact[] = {{"binary64", 53}, {"extended", 64}, {"binary128", 113}, {"mpfr:300", 300}};
	static const char *const families[] = {"grazing", "near-contact", "quadratics", "huge-times", "just-overlapping"};
	struct oracle *oracle = oracle_create();
	struct finder_truth *truth = finder_truth_create(QUESTIONS, 300);
	struct finder_bits *bits = calloc(1, sizeof *bits);
	question number[QUESTIONS];
	for (size_t e = 0; e < sizeof exact / sizeof *exact; e++) {
		finder_bits_begin(bits);
		for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
			draw_questions(families[f], number);
			finder_truth_solve(truth, oracle, TOUCHSTONE_BALL_BALL, (void *)number, QUESTIONS);
			assert_true(finder_bits_add(bits, truth, oracle, exact[e].arithmetic, "rounded", error));
		}
		print_message("rounded in %s: at least %.3f bits\n", exact[e].arithmetic, bits->least);
		assert_true(bits->least >= exact[e].bits && bits->least < exact[e].bits + 2);
	}
	free(bits);
	finder_truth_destroy(truth);
	oracle_destroy(oracle);
}

/* ---- the command */

static const char HEADING[] = "kind,name,arithmetic,ns,cost_ratio,error_bits,horizon\n";
#define FEW \
	"chart --cases 100 --starts 2 --method stable --method naive --method kahan --arith binary32 --arith binary64"

struct row {
	char kind[16], name[32], arithmetic[32];
	double number[4];
};

static double field(const char **at)
{
	char *end;
	double value = strtod(*at, &end);
	bool empty = end == *at;
	assert_true(*end == ',' || *end == '\n');
	*at = end + 1;
	return empty ? NAN : value;
}

static size_t read_csv(const char *text, struct row *rows, size_t room)
{
	size_t count = 0;
	if (strncmp(text, HEADING, strlen(HEADING)) != 0) fail_msg("heading: %s", text);
	for (const char *line = strchr(text, '\n') + 1; *line; count++) {
		assert_true(count < room);
		struct row *row = &rows[count];
		int length;
		assert_int_equal(sscanf(line, "%15[^,],%31[^,],%31[^,],%n", row->kind, row->name, row->arithmetic, &length), 3);
		line += length;
		for (int n = 0; n < 4; n++) row->number[n] = field(&line);
	}
	return count;
}

static void the_csv_is_as_agreed(void **state)
{
	(void)state;
	struct said said = program_run(FEW " --csv -");
	struct row rows[20];
	if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
	assert_string_equal(said.err, "");
	assert_int_equal(read_csv(said.out, rows, 20), 3 * 2 + 2 * 2); /* kahan runs no engine */
	for (int r = 0; r < 10; r++) {
		bool engine = r >= 6, coarse = r % 2 == 0;
		const double *number = rows[r].number;
		assert_string_equal(rows[r].kind, engine ? "engine" : "finder");
		assert_string_equal(rows[r].arithmetic, coarse ? "binary32" : "binary64");
		assert_true(isfinite(number[0]) && number[1] > 0);
		assert_true(isnan(number[2]) == engine && isnan(number[3]) != engine);
		double worth = engine ? number[3] : number[2];
		assert_true(coarse ? worth > 0 : worth > rows[r - 1].number[engine ? 3 : 2]);
	}
	said_free(&said);
}

/* But for times, the numbers do not depend on the number of threads. */
static void numbers_do_not_depend_on_threads(void **state)
{
	(void)state;
	struct row rows[2][4];
	for (int run = 0; run < 2; run++) {
		struct said said = program_run("chart --method rounded --arith binary64 --arith mpfr:70 --cases 50 --starts 2 "
									   "--csv - --seed 5 --threads %d",
									   1 + 2 * run);
		assert_int_equal(said.status, 0);
		assert_int_equal(read_csv(said.out, rows[run], 4), 4);
		said_free(&said);
	}
	for (int r = 0; r < 4; r++)
		for (int n = 2; n < 4; n++) {
			double one = rows[0][r].number[n], three = rows[1][r].number[n];
			assert_true(one == three || (isnan(one) && isnan(three)));
		}
	assert_true(rows[0][0].number[2] >= 53 && rows[0][1].number[2] >= 70);
	assert_true(rows[0][2].number[3] < rows[0][3].number[3]);
}

/* Little time means fewer questions, and still every number. */
static void seconds_are_kept_to(void **state)
{
	(void)state;
	struct row rows[2];
	struct said said = program_run("chart --full --seconds 1 --method naive --arith binary32 --csv -");
	assert_int_equal(said.status, 0);
	assert_int_equal(read_csv(said.out, rows, 2), 2);
	assert_true(rows[0].number[2] > 10 && rows[1].number[3] > 0.5);
	said_free(&said);
}

static void the_chart_becomes_a_page(void **state)
{
	(void)state;
	struct said said = program_run(FEW " --results %s/results", folder);
	if (said.status != 0) fail_msg("status %d: %s", said.status, said.err);
	assert_non_null(strstr(said.out, "Finders, harvested questions"));
	assert_non_null(strstr(said.out, "Finders, hand-made questions"));
	assert_non_null(strstr(said.out, "Engines, 500 elastic hard spheres"));
	said_free(&said);
	said = program_run("report --results %s/results --output %s/report", folder, folder);
	if (said.status != 0 || *said.err) fail_msg("status %d: %s", said.status, said.err);
	said_free(&said);
	char *report;
	assert_true(asprintf(&report, "%s/report", folder) > 0);
	char *svg = folder_text(report, "chart-bits.svg"), *page = folder_text(report, "chart.html");
	char *csv = folder_text(report, "chart-bits.csv");
	static const char *const methods[] = {"stable", "naive", "kahan"};
	for (int m = 0; m < 3; m++) {
		char mark[120], grades[40];
		snprintf(mark, sizeof mark, "xlink:href=\"grade-%s.html\"><title>%s in binary64\n", methods[m], methods[m]);
		if (!strstr(svg, mark)) fail_msg("no mark: %s", mark);
		snprintf(grades, sizeof grades, "grade-%s.html", methods[m]);
		assert_int_equal(folder_count(report, grades), 1);
	}
	assert_non_null(strstr(svg, "bits right in 99.9 % of the answers"));
	assert_non_null(strstr(page, "data=\"chart-bits.svg\""));
	assert_non_null(strstr(csv, "harvested questions,throughput,stable,stable binary64,"));
	static const char *const files[] = {"chart-bits.pdf", "chart-faults.svg", "chart-faults.pdf", "chart-engines.svg",
										"chart-engines.pdf"};
	for (size_t f = 0; f < sizeof files / sizeof *files; f++) assert_int_equal(folder_count(report, files[f]), 1);
	free(csv);
	free(page);
	free(svg);
	free(report);
}

/* Stopped by a signal, it tells what was measured by then. */
static void an_interrupt_keeps_what_is_done(void **state)
{
	(void)state;
	char *csv, *results;
	assert_true(asprintf(&csv, "%s/stopped.csv", folder) > 0 && asprintf(&results, "%s/stopped", folder) > 0);
	pid_t process = fork();
	if (process == 0) {
		if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(99);
		execl(TOUCHSTONE_PROGRAM, TOUCHSTONE_PROGRAM, "chart", "--full", "--csv", csv, "--results", results, NULL);
		_exit(99);
	}
	for (int wait = 0; wait < 1000 && folder_count(folder, "stopped") == 0; wait++) usleep(10000);
	usleep(500000);
	kill(process, SIGINT);
	assert_int_equal(program_status(process), 130);
	struct row rows[200];
	char *text = folder_text(folder, "stopped.csv"), *chart = folder_text(results, "chart.json");
	assert_true(read_csv(text, rows, 200) > 50);
	assert_non_null(strstr(chart, "\"complete\": false"));
	free(chart);
	free(text);
	free(results);
	free(csv);
}

static void bad_usage_is_one_line(void **state)
{
	(void)state;
	static const struct {
		const char *arguments, *words;
	} wrong[] = {
		{"stable", "chart: 'stable' is too much"},
		{"--method fastest", "fastest"},
		{"--arith decimal", "no arithmetic 'decimal'"},
		{"--arith mpfr:600", "mpfr:600"},
		{"--seconds 0", "--seconds: '0'; accepted: seconds"},
		{"--seconds soon", "--seconds: 'soon'"},
		{"--cases 0", "--cases: '0'"},
		{"--starts 0", "--starts: '0'"},
		{"--seed -1", "--seed: '-1'"},
		{"--threads 0", "--threads: '0'"},
		{"--csv nowhere/file.csv", "nowhere/file.csv"},
		{"--results /dev/null/results", "/dev/null/results"},
	};
	for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++)
		program_refused(program_run("chart %s", wrong[w].arguments), wrong[w].words);
}

static int begin(void **state)
{
	(void)state;
	folder = folder_new();
	return 0;
}

static int end(void **state)
{
	(void)state;
	folder_remove(folder);
	return 0;
}

int main(void)
{
	print_message("seed %d\n", SEED);
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_frontier_is_a_rising_staircase),
		cmocka_unit_test(unrounded_answers_round_to_the_answers),
		cmocka_unit_test(bits_are_those_of_the_definition),
		cmocka_unit_test(correct_rounding_has_all_its_bits),
		cmocka_unit_test(the_csv_is_as_agreed),
		cmocka_unit_test(numbers_do_not_depend_on_threads),
		cmocka_unit_test(seconds_are_kept_to),
		cmocka_unit_test(the_chart_becomes_a_page),
		cmocka_unit_test(an_interrupt_keeps_what_is_done),
		cmocka_unit_test(bad_usage_is_one_line),
	};
	return cmocka_run_group_tests(tests, begin, end);
}
