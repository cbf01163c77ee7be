#include "bench/measure.h"

#include <math.h>
#include <stdio.h>

#include "bench/instructions.h"
#include "bench/timing.h"
#include "command/command.h"
#include "command/interrupt.h"
#include "command/progress.h"
#include "command/simulation.h"

static const uint64_t million = 1000000; /* plates */

struct campaign {
	struct findings *findings;
	struct scene_file *file[POINTS];
	bool failed[POINTS]; /* said once, and not tried again */
	struct progress progress;
	double done, all;
};

static void part_done(struct campaign *campaign)
{
#pragma omp critical(bench_progress)
	progress_show(&campaign->progress, 100 * ++campaign->done / campaign->all, 100);
}

/* What went wrong; nothing did when a signal ended it. */
static void fault(struct campaign *campaign, const char *what)
{
	if (!*what) return;
#pragma omp critical(bench_progress)
	{
		progress_end(&campaign->progress);
		refuse("%s", what);
		campaign->findings->faults++;
	}
}

static void time_point(struct campaign *campaign, int p)
{
	struct engine_cost *cost = &campaign->findings->engine[p];
	struct engine_timing timing;
	char error[STORE_ERROR], name[POINT_NAME];
	uint64_t events = effort_events(&campaign->findings->effort, points[p].events);
	if (campaign->failed[p]) return;
	if (!engine_time(campaign->file[p], events, interrupt_flag(), &timing, error)) {
		campaign->failed[p] = true;
		fault(campaign, error);
		return;
	}
	if (cost->digest && cost->digest != timing.digest) {
		snprintf(error, sizeof error, "%s: %016llx is the digest of one run, %016llx of the same another time",
				 point_name(&points[p], name), (unsigned long long)cost->digest, (unsigned long long)timing.digest);
		fault(campaign, error);
	}
	cost->digest = timing.digest;
	cost->bytes = timing.bytes;
	sample_add(&cost->start_up, timing.start_up);
	sample_add(&cost->event, timing.event);
}

/* What is not an engine by itself: balls over plates, and two engines at once. */
static void time_others(struct campaign *campaign)
{
	struct findings *findings = campaign->findings;
	char error[STORE_ERROR];
	double seconds, times;
	uint64_t plates = effort_events(&(struct effort){.scale = fmin(1, findings->effort.scale)}, million);
	if (drop_time(plates, interrupt_flag(), &seconds, error))
		sample_add(&findings->drop, seconds * (double)million / (double)plates);
	else
		fault(campaign, error);
	part_done(campaign);
	for (int s = 0; s < SPEED_UPS && findings->cores.count > 1 && !interrupted(); s++) {
		int p = point_of("hard-spheres", speed_up_particles[s], 0.5, "binary64", "cells");
		uint64_t events = effort_events(&findings->effort, points[p].events);
		if (speed_up(campaign->file[p], events, &findings->cores, interrupt_flag(), &times, error))
			sample_add(&findings->speed_up[s], times);
		else
			fault(campaign, error);
		part_done(campaign);
	}
}

/* Everything once, and then again: whatever slows the machine for a while does not meet one kind alone. */
static void time_all(struct campaign *campaign)
{
	cores_stay(campaign->findings->cores.chosen[0]);
	for (unsigned repetition = 0; repetition < campaign->findings->effort.repetitions; repetition++) {
		for (int p = 0; p < POINTS && !interrupted(); p++) {
			time_point(campaign, p);
			part_done(campaign);
		}
		if (!interrupted()) time_others(campaign);
	}
	cores_roam(&campaign->findings->cores);
}

/* Counts do not depend on what else runs, so all cores take part. */
static void count_all(struct campaign *campaign)
{
	struct findings *findings = campaign->findings;
#pragma omp parallel for schedule(dynamic, 1) num_threads(findings->cores.count)
	for (int p = POINTS - 1; p >= 0; p--) {
		char error[REPORT_ERROR];
		if (interrupted() || !point_counted(&points[p], &findings->effort)) continue;
		cores_roam(&findings->cores);
		findings->engine[p].instructions = instructions_count(&points[p], &findings->effort, interrupt_flag(), error);
		if (isnan(findings->engine[p].instructions)) fault(campaign, error);
		part_done(campaign);
	}
}

static bool open_all(struct campaign *campaign, char error[STORE_ERROR])
{
	for (int p = 0; p < POINTS; p++) {
		campaign->file[p] = point_open(&points[p], &campaign->findings->effort, error);
		if (!campaign->file[p] || !simulation_names(campaign->file[p], error)) return false;
	}
	return true;
}

bool measure_all(struct findings *findings, char error[STORE_ERROR])
{
	struct campaign campaign = {.findings = findings};
	bool good = open_all(&campaign, error);
	if (good) {
		bool counts = instructions_possible();
		findings->cores = cores_look();
		campaign.all = findings->effort.repetitions * (POINTS + 1 + (findings->cores.count > 1 ? SPEED_UPS : 0));
		for (int p = 0; counts && p < POINTS; p++) campaign.all += point_counted(&points[p], &findings->effort);
		if (!counts)
			snprintf(findings->uncounted, sizeof findings->uncounted,
					 "valgrind is not installed, so instructions are "
					 "not counted");
		interrupt_watch();
		campaign.progress = progress_begin("bench", "%");
		time_all(&campaign);
		if (counts && !interrupted()) count_all(&campaign);
		progress_end(&campaign.progress);
		findings->stopped = interrupted();
		if (!findings_agree(findings))
			fault(&campaign, "mpfr:113: with the sieve, events are not what they are "
							 "without");
	}
	for (int p = 0; p < POINTS; p++) scene_file_close(campaign.file[p]);
	return good;
}
