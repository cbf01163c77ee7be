/* SIGKILL at random moments: `make soak` kills 100 runs with checkpoints, or `make soak KILLS=1000`, resumes each from
 * what it had kept, and holds the digest in which it ends against that of the run that nobody killed. Scenes and
 * arithmetics in turn. Ctrl-C ends it with what was found so far. Exit status: 0 when all agreed, 1 when one did not, 2
 * for wrong usage. */
#include <stdio.h>

#include "command/interrupt.h"
#include "soak/kills.h"

enum { SEED = 20161114, KILLS_A_RUN = 6 };

static const char *const scenes[] = {
	"hard-spheres --set particles=2000 --events 2e5",
	"square-well --set particles=2000 --set density=0.2 --events 1e5 --measure conservation",
	"inelastic-spheres --set particles=500 --set equilibrate=20 --events 1e5 --arithmetic twin",
	"stepped-lennard-jones --set particles=500 --events 6e4 "
	"--set 'virtual_walls=[{point: [0, 0, 0], normal: [1, 0, 0]}]'",
	"mixture --set particles=1000 --events 1e5 --arithmetic binary32 --set form=absolute",
	"square-shoulder --set particles=500 --events 4e4 --arithmetic mpfr:200 --measure impact",
	"discs --set particles=1000 --events 1e5 --arithmetic short:20",
	"column --events 3e4 --arithmetic binary128",
};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* Kills runs of one scene; false when what came of it is not what should have. */
static bool soak(const struct kills *kills, struct random_state *random, struct kills_tally *tally)
{
	char expected[17], digest[17] = "none";
	unsigned before = tally->killed;
	double clock = progress_clock();
	bool ran = kills_run(kills, 0, 0, random, tally, expected);
	double seconds = progress_clock() - clock;
	bool same =
		ran && kills_run(kills, KILLS_A_RUN, seconds / 2, random, tally, digest) && strcmp(digest, expected) == 0;
	bool stopped = interrupted(); /* then the runs were, too */
	printf("%-100s %s, %u kills%s\n", kills->scene, digest, tally->killed - before,
		   stopped ? ": stopped"
		   : same  ? ""
				   : ": NOT the digest of the unbroken run");
	fflush(stdout);
	return same || stopped;
}

int main(int argc, char **argv)
{
	uint64_t wanted = 100;
	if (argc > 2 || (argc == 2 && !text_count(argv[1], &wanted))) {
		fprintf(stderr, "kill_soak: accepted: how many kills, such as 1000\n");
		return 2;
	}
	char folder[] = "/tmp/touchstone-kills-XXXXXX";
	if (!mkdtemp(folder)) {
		perror("kill_soak");
		return 2;
	}
	interrupt_watch();
	struct random_state random = random_seed(SEED);
	struct kills_tally tally = {0};
	unsigned runs = 0, wrong = 0;
	printf("seed %d\n", SEED);
	for (; tally.killed < wanted && !interrupted(); runs++) {
		struct kills kills = {TOUCHSTONE_PROGRAM, folder, scenes[runs % SCENES], 1 + random_below(&random, 8000)};
		wrong += !soak(&kills, &random, &tally);
	}
	rmdir(folder);
	printf("%u kills in %u runs, %u while a checkpoint was written; %u parts resumed; %u checkpoints not whole%s%s, "
		   "%u digests wrong\n",
		   tally.killed, runs, tally.writing, tally.resumed, tally.unwhole, tally.unwhole ? ": " : "", tally.error,
		   wrong);
	return wrong || tally.unwhole;
}
