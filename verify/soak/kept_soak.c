/* SIGKILL at random moments of campaigns and audits, in turn: `kept_soak 1000` kills that many, 100 when not told. What
 * was kept before a kill must stand unchanged in front of what is kept after it; and a campaign that was killed comes
 * in the end to the results of one that was not. Ctrl-C ends it with what was found so far. Exit status: 0 when nothing
 * was lost, 1 when something was, 2 for wrong usage. */
#include <inttypes.h>

#include "campaign/piece_store.h"
#include "command/interrupt.h"
#include "soak/kills.h"
#include "store/history.h"

enum { SEED = 20260317 };

struct keeper {
	const char *name, *command; /* which ends with the path of what is kept in the folder */
	const char *kept;
	char *(*text)(const char *path); /* all that was kept for good, in order; from malloc */
};

/* The lines of a store that are whole. */
static char *text_of_store(const char *path)
{
	size_t room = 0;
	char *text = NULL;
	FILE *stream = fopen(path, "r");
	if (!stream) return strdup("");
	if (getdelim(&text, &room, '\0', stream) < 0) *text = '\0';
	fclose(stream);
	char *end = strrchr(text, '\n');
	text[end ? end - text + 1 : 0] = '\0';
	return text;
}

static void write_row(void *context, const struct history_row *row)
{
	const char *check = row->check ? row->check : "", *measure = row->measure ? row->measure : "";
	if (strcmp(row->state, "complete") != 0) return;
	fprintf(context, "%" PRId64 " %s %s %s %" PRIu64 " %a\n", row->audit, row->date, check, measure, row->seed,
			row->measured.value);
}

/* The audits of a history that came to their end. */
static char *text_of_history(const char *path)
{
	char *text = NULL, error[STORE_ERROR];
	size_t length;
	if (access(path, F_OK) != 0) return strdup("");
	struct history *history = history_open(path, true, error);
	FILE *stream = open_memstream(&text, &length);
	bool read = history && stream && history_read(history, write_row, stream, error);
	if (stream) fclose(stream);
	history_close(history);
	if (!read) fprintf(stderr, "kept_soak: %s\n", error);
	if (read) return text;
	free(text);
	return NULL;
}

static const struct keeper keepers[] = {
	{"campaign", "campaign verify/fuzz/small-campaign.yaml --results", "small-campaign.pieces", text_of_store},
	{"audit", "audit --suite verify/fuzz/small-suite.yaml --history", "history.db", text_of_history},
};
enum { KEEPERS = sizeof keepers / sizeof *keepers };

/* Runs once, for so many seconds at most; true when it came to its end. */
static bool run(const struct keeper *keeper, const char *folder, double seconds)
{
	char command[600];
	snprintf(command, sizeof command, "exec %s %s %s%s", TOUCHSTONE_PROGRAM, keeper->command, folder,
			 keeper->text == text_of_history ? "/history.db" : "");
	double deadline = progress_clock() + seconds;
	pid_t process = kills_start(command);
	int status;
	while (waitpid(process, &status, WNOHANG) == 0) {
		if (progress_clock() > deadline) kill(process, SIGKILL);
		usleep(100);
	}
	return !WIFSIGNALED(status);
}

/* The results of two campaigns, but for when and how they were made. */
static bool same_results(const char *one, const char *other)
{
	char error[512];
	struct piece_store *store[2] = {piece_store_read(one, NULL, error), piece_store_read(other, NULL, error)};
	bool same = store[0] && store[1];
	if (same) same = json_object_size(piece_store_lines(store[0])) == json_object_size(piece_store_lines(store[1]));
	const char *key;
	json_t *line;
	if (same)
		json_object_foreach(piece_store_lines(store[0]), key, line) same =
			same && piece_store_find(store[1], key) &&
			piece_store_same(piece_store_find(store[0], key), piece_store_find(store[1], key));
	for (int s = 0; s < 2; s++) piece_store_close(store[s], NULL);
	return same;
}

struct tally {
	uint64_t killed, kept; /* and those of them after which there was something kept */
	unsigned lost;
};

/* Kills until it has come to its end. */
static void soak(const struct keeper *keeper, const char *folder, const char *whole, double seconds,
				 struct random_state *random, struct tally *tally)
{
	char path[400], undisturbed[400];
	snprintf(path, sizeof path, "%s/%s", folder, keeper->kept);
	snprintf(undisturbed, sizeof undisturbed, "%s/%s", whole, keeper->kept);
	bool ended = false;
	for (int tries = 0; !ended && !interrupted(); tries++) {
		char *before = keeper->text(path);
		ended = run(keeper, folder, tries < 5 ? seconds * random_uniform(random) : 1e9);
		char *after = keeper->text(path);
		if (!before || !after || strncmp(before, after, strlen(before)) != 0) tally->lost++;
		tally->killed += !ended;
		tally->kept += !ended && after && *after;
		free(before);
		free(after);
	}
	if (keeper->text != text_of_store || interrupted()) return;
	tally->lost += !same_results(path, undisturbed);
	unlink(path);
}

int main(int argc, char **argv)
{
	uint64_t wanted = 100;
	struct tally tally[KEEPERS] = {0};
	double seconds[KEEPERS];
	if (argc > 2 || (argc == 2 && !text_count(argv[1], &wanted))) {
		fprintf(stderr, "kept_soak: accepted: how many kills, such as 1000\n");
		return 2;
	}
	char folder[] = "/tmp/touchstone-kept-XXXXXX", whole[] = "/tmp/touchstone-whole-XXXXXX", command[200];
	if (!mkdtemp(folder) || !mkdtemp(whole)) return perror("kept_soak"), 2;
	interrupt_watch();
	struct random_state random = random_seed(SEED);
	for (int k = 0; k < KEEPERS; k++) {
		double clock = progress_clock();
		run(&keepers[k], whole, 1e9);
		seconds[k] = progress_clock() - clock;
	}
	while (tally[0].killed + tally[1].killed < wanted && !interrupted())
		for (int k = 0; k < KEEPERS; k++) soak(&keepers[k], folder, whole, seconds[k], &random, &tally[k]);
	printf("seed %d", SEED);
	for (int k = 0; k < KEEPERS; k++)
		printf("; %s: %" PRIu64 " kills, %" PRIu64 " with something kept before, lost after %u", keepers[k].name,
			   tally[k].killed, tally[k].kept, tally[k].lost);
	printf("\n");
	snprintf(command, sizeof command, "rm -rf %s %s", folder, whole);
	return system(command) != 0 || tally[0].lost + tally[1].lost > 0;
}
