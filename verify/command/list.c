/* touchstone list: what there is, with one line each. */
#include "command/command.h"

#include <argp.h>
#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "audit/suite.h"
#include "campaign/campaign_file.h"
#include "command/cases.h"
#include "command/run_measures.h"
#include "family/family.h"
#include "store/query_file.h"
#include "store/scene_file.h"
#include "touchstone.h"

/* What the library's names mean; bits: 0 where the name says them. */
static const struct {
	const char *name, *about;
	int bits;
} arithmetics[] = {
	{"short:P", "binary64 operations each rounded to P significant bits, P from 4 to 25", 0},
	{"binary32", "IEEE single precision: 24 significant bits", 24},
	{"binary64", "IEEE double precision, the production engine: 53 significant bits", 53},
	{"extended", "x87 long double: 64 significant bits", 64},
	{"twin", "double-double, the sum of two doubles: about 106 significant bits", 106},
	{"binary128", "IEEE quadruple precision, in software: 113 significant bits", 113},
	{"mpfr:P", "GNU MPFR with P significant bits, P from 2 to 1024, and exponents without end", 0},
};
enum { ARITHMETICS = sizeof arithmetics / sizeof *arithmetics };

static const struct {
	const char *name, *about;
} methods[] = {
	{"stable", "2014 paper, algorithms 1 and 2: an event when bodies touch or overlap, and approach"},
	{"naive", "2014 paper, eq. 12 and section 3: textbook roots, whatever the rounding made of them"},
	{"guarded", "a simulator's guards: slow balls and balls that overlap have no event"},
	{"compensated", "the stable rule over a, b, c and a discriminant formed in twice the precision"},
	{"rounded", "the time of the stable rule, correctly rounded"},
	{"rewind", "2014 paper, section 3: textbook roots, negative times executed, the clock going back"},
	{"skip", "2014 paper, section 3: bodies that overlap are not tested until they have parted"},
	{"search", "Allen, Frenkel and Talbot 1989: an overlap at contact is walked back to where there is none"},
	{"shrink", "Poeschel and Schwager 2005: contacts are looked for a little early"},
	{"tc", "Luding and McNamara 1998: elastic within a contact time after a collision"},
	{"positional", "Alder and Wainwright 1959: a pair's state is read from its separation each time it is tested"},
	{"stretch", "positional, with a small time added to events, so that pairs come to lie where they belong"},
	{"nudge", "positional, with pairs moved across the step where an event has left them on its wrong side"},
	{"last-event", "positional, but two that have just met are not looked at for a short time"},
	{"numerical-recipes", "finder only: Press and others, eqs. 5.6.4 and 5.6.5"},
	{"kahan", "finder only: Kahan's discriminant, by fused multiply-adds"},
	{"sterbenz", "finder only: Sterbenz's scaling, then as kahan"},
	{"textbook-epsilon", "finder only: two moving balls as in Ericson, section 5.5.5"},
};
enum { METHODS = sizeof methods / sizeof *methods };

int arithmetic_bits(const char *name)
{
	const char *colon = strchr(name, ':');
	if (colon) return atoi(colon + 1);
	for (int a = 0; a < ARITHMETICS; a++)
		if (strcmp(arithmetics[a].name, name) == 0) return arithmetics[a].bits;
	return 0;
}

static void print(const char *name, const char *about)
{
	printf("  %-18s  %s\n", name, about);
}

static bool list_arithmetics(const char *folder)
{
	(void)folder;
	const char *name;
	for (size_t n = 0; (name = touchstone_arithmetic_name(n)); n++) {
		const char *about = "";
		for (int a = 0; a < ARITHMETICS; a++)
			if (strcmp(arithmetics[a].name, name) == 0) about = arithmetics[a].about;
		print(name, about);
	}
	return true;
}

static bool list_methods(const char *folder)
{
	(void)folder;
	for (int m = 0; m < METHODS; m++) print(methods[m].name, methods[m].about);
	return true;
}

static bool list_measures(const char *folder)
{
	(void)folder;
	for (const struct run_measure_entry *entry = run_measures; entry->name; entry++) print(entry->name, entry->about);
	return true;
}

static bool list_figures(const char *folder)
{
	(void)folder;
	for (const struct figure_entry *figure = figures; figure->name; figure++) print(figure->name, figure->about);
	print("chart", "speed against accuracy of finders and engines: made by `touchstone chart`");
	return true;
}

/* The shapes a family has, and where it comes from. */
static bool list_families(const char *folder)
{
	(void)folder;
	const struct family *family;
	for (size_t f = 0; (family = family_at(f)); f++) {
		print(family->name, family->about);
		printf("  %-18s  %s;", "", family->origin == FAMILY_HARVESTED ? "harvested" : "hand-made");
		for (int s = 0; s < TOUCHSTONE_SHAPES; s++)
			if (family->shapes >> s & 1) printf(" %s", shape_name((enum touchstone_shape)s));
		printf("\n");
	}
	return true;
}

static int is_scene(const struct dirent *entry)
{
	const char *ending = strrchr(entry->d_name, '.');
	return *entry->d_name != '.' && ending && strcmp(ending, ".yaml") == 0;
}

/* A scene in a folder of the cases, by which it is then called as well. One that cannot be read is said so; the others
 * are listed all the same. */
static bool list_scene(const char *folder, const char *within, const char *base)
{
	char *path, name[80], error[STORE_ERROR];
	if (asprintf(&path, "%s/%s%s", folder, within, base) < 0) return false;
	struct scene_file *file = scene_file_open(path, 0, NULL, error);
	free(path);
	if (file) snprintf(name, sizeof name, "%s%s", within, file->name);
	if (file)
		print(name, file->title);
	else
		refuse("%s", error);
	scene_file_close(file);
	return file;
}

static bool list_case(const char *folder, const char *base)
{
	return list_scene(folder, "", base);
}

static bool list_stress(const char *folder, const char *base)
{
	return list_scene(folder, "stress/", base);
}

/* The same for a campaign, whose scene may be one of the cases. */
static bool list_campaign(const char *folder, const char *base)
{
	char *path, error[STORE_ERROR];
	if (asprintf(&path, "%s/campaigns/%s", folder, base) < 0) return false;
	struct campaign_file *file = campaign_file_open(path, folder, error);
	free(path);
	if (file)
		print(file->name, file->title);
	else
		refuse("%s", error);
	campaign_file_close(file);
	return file;
}

/* And for a suite. */
static bool list_suite(const char *folder, const char *base)
{
	char *path, error[STORE_ERROR];
	if (asprintf(&path, "%s/suites/%s", folder, base) < 0) return false;
	struct suite *suite = suite_open(path, folder, error);
	free(path);
	if (suite)
		print(suite->name, suite->title);
	else
		refuse("%s", error);
	suite_close(suite);
	return suite;
}

/* Lists what the folder of the cases holds, or one in it, which need not be there. */
static bool list_entries(const char *folder, const char *within, bool (*list)(const char *folder, const char *base))
{
	struct dirent **entries;
	char *path;
	if (asprintf(&path, "%s%s", folder, within) < 0) return false;
	int count = scandir(path, &entries, is_scene, versionsort);
	bool absent = count < 0 && errno == ENOENT && *within, good = count >= 0 || absent;
	if (!good) refuse("--cases: %s: cannot be read: %s; accepted: a folder with scenes", path, strerror(errno));
	for (int e = 0; e < count; e++) {
		good &= list(folder, entries[e]->d_name);
		free(entries[e]);
	}
	if (count >= 0) free(entries);
	free(path);
	return good;
}

static bool list_cases(const char *folder)
{
	bool plain = list_entries(folder, "", list_case), stress = list_entries(folder, "/stress", list_stress);
	return plain && stress;
}

static bool list_campaigns(const char *folder)
{
	return list_entries(folder, "/campaigns", list_campaign);
}

static bool list_suites(const char *folder)
{
	return list_entries(folder, "/suites", list_suite);
}

static const struct kind {
	const char *name;
	bool (*list)(const char *folder);
} kinds[] = {
	{"cases", list_cases},       {"methods", list_methods},   {"arithmetics", list_arithmetics},
	{"families", list_families}, {"figures", list_figures},   {"campaigns", list_campaigns},
	{"suites", list_suites},     {"measures", list_measures},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

struct wish {
	const struct kind *kind; /* NULL: all */
	const char *folder;
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
	struct wish *wish = state->input;
	switch (key) {
	case 'c':
		wish->folder = argument;
		return 0;
	case ARGP_KEY_ARG:
		if (wish->kind)
			refuse_usage("list: more than one kind; accepted: one of cases, methods, arithmetics, families, figures, "
						 "campaigns, suites, measures");
		for (int k = 0; k < KINDS; k++)
			if (strcmp(kinds[k].name, argument) == 0) wish->kind = &kinds[k];
		if (!wish->kind)
			refuse_usage(
				"list: no kind '%.60s'; accepted: cases, methods, arithmetics, families, figures, campaigns, suites, "
				"measures",
				argument);
		return 0;
	default:
		return ARGP_ERR_UNKNOWN;
	}
}

int command_list(int argc, char **argv)
{
	static const struct argp_option options[] = {
		{"cases", 'c', "DIR", 0, "Folder of the cases (cases, or the one Touchstone was built from)", 0}, {0}};
	static const struct argp argp = {
		.options = options,
		.parser = parse,
		.args_doc = "[cases|methods|arithmetics|families|figures|campaigns|suites|measures]",
		.doc = "Lists what there is, with one line each: scenes that `run` knows by name, methods and arithmetics, "
			   "families of questions to finders, figures that `reproduce` makes, campaigns, suites of "
			   "`audit`, measures of `run` and of campaigns.\vExample: touchstone list "
			   "methods",
	};
	struct wish wish = {0};
	argp_parse(&argp, argc, argv, 0, NULL, &wish);
	const char *folder = cases_folder(wish.folder);
	bool good = true;
	for (int k = 0; k < KINDS; k++) {
		if (wish.kind && wish.kind != &kinds[k]) continue;
		if (!wish.kind) printf("%s\n", kinds[k].name);
		good &= kinds[k].list(folder);
	}
	return good ? STATUS_WELL : STATUS_REFUSED;
}
