/* What becomes of methods that read states from positions, found and named by a watcher. */
#include "figure/step_gas.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const methods[] = {"stable", "positional", "stretch", "nudge", "last-event"};
static const char *const arithmetics[] = {"short:20", "binary32", "binary64", "mpfr:106"};
enum { METHODS = 5, ARITHMETICS = 4, SCENES = 2, PARTICLES = 500 };

/* In the papers' absolute form, from the lattice on, so that the command that shows it is short. */
size_t states_rivals_gases(bool full, struct step_gas *gases)
{
	size_t count = 0;
	for (int m = 0; m < METHODS; m++)
		for (int a = 0; a < ARITHMETICS; a++)
			for (int g = 0; g < SCENES; g++)
				gases[count++] = (struct step_gas){.shoulder = g,
												   .particles = PARTICLES,
												   .form = TOUCHSTONE_ABSOLUTE,
												   .arithmetic = arithmetics[a],
												   .method = methods[m],
												   .events = (full ? 200000 : 60000) / (a < 3 ? 1 : 15),
												   .watched = true};
	return count;
}

/* How bad it is: 0, nothing; energy from nowhere; stuck or ended. */
static unsigned level(const struct step_gas_outcome *outcome)
{
	const struct misreading *misreading = &outcome->misreading;
	if (misreading->stuck.event || outcome->end.verdict != TOUCHSTONE_DONE) return TABLE_LEVELS - 1;
	return misreading->energy != 0 ? 2 : misreading->repeats + misreading->misses > 0;
}

/* The event with which it first goes wrong. */
static const struct misread_pair *earliest(const struct misreading *misreading)
{
	const struct misread_pair *first = &misreading->repeated, *other = &misreading->missed;
	if (!first->event || (other->event && other->event < first->event)) first = other;
	return first->event ? first : &misreading->stuck;
}

static void name_it(struct result_table table, const struct step_gas_outcome *outcome)
{
	const struct misreading *misreading = &outcome->misreading;
	char said[400] = "";
	size_t used = 0;
	if (misreading->repeats) used += (size_t)snprintf(said, sizeof said, "events repeated");
	if (misreading->misses)
		used += (size_t)snprintf(said + used, sizeof said - used, "%sa third particle missed", used ? "; " : "");
	if (misreading->stuck.event)
		used += (size_t)snprintf(said + used, sizeof said - used, "%sstuck on %ss from event %llu on", used ? "; " : "",
								 misreading_event(misreading->stuck.kind),
								 (unsigned long long)misreading->stuck.event - MISREADING_STUCK + 1);
	else if (outcome->end.verdict == TOUCHSTONE_COLLAPSED)
		used += (size_t)snprintf(said + used, sizeof said - used, "%stime stands still before event %llu",
								 used ? "; " : "", (unsigned long long)misreading->events);
	if (misreading->energy != 0)
		snprintf(said + used, sizeof said - used, "%senergy %s by %g kT", used ? "; " : "",
				 misreading->energy > 0 ? "rises" : "falls", fabs(misreading->energy));
	table_shaded(table, level(outcome), "%s", *said ? said : "nothing goes wrong");
}

static void claim_stuck(struct result *result, const struct step_gas *gas, const struct step_gas_outcome *outcome)
{
	const struct misread_pair *stuck = &outcome->misreading.stuck;
	bool agrees = stuck->event && stuck->kind == TOUCHSTONE_RELEASE && outcome->misreading.energy > 0;
	char shown[200], text[200];
	snprintf(shown, sizeof shown, "%s; %g kT from nowhere in %llu events", misreading_tell(stuck, text),
			 outcome->misreading.energy, (unsigned long long)outcome->end.events);
	result_claim(result,
				 &(struct result_claim){
					 .quantity = "Alder and Wainwright's reading of states, square shoulder, binary64",
					 .reported = "becomes stuck and repeatedly executes identical release events; the kinetic energy "
								 "increases with each",
					 .where = "2016, section 5",
					 .measured = (double)stuck->event,
					 .shown = shown,
					 .count = outcome->end.events,
					 .verdict = agrees ? RESULT_AGREES : RESULT_DIFFERS,
					 .why = agrees ? "With times and positions in the papers' absolute form. A pair that has left its "
									 "shoulder is read as still on it, and leaves it again, for ever, at the same time."
								   : "It goes wrong otherwise here; the table says how.",
				 });
	(void)gas;
}

void states_rivals_tell(struct result *result, const struct step_gas *gases, const struct step_gas_outcome *outcomes,
						uint64_t seed)
{
	static const char *const columns[] = {"method",   "scene",  "arithmetic", "what goes wrong", "first",
										  "repeated", "missed", "events",     "command",         NULL};
	struct result_table table = result_table(
		result, "Methods that read states from positions: the first event that goes wrong",
		"500 particles from the lattice, in the papers' absolute form, watched by a ledger of its own: repeated, a "
		"pair "
		"was read as what it was before its own event right after it; missed, it was read otherwise when a third "
		"particle "
		"met one of the two; stuck, the same event 16 times in a row at no later time. Energy is potential energy that "
		"changed without an event. A run ends where thousands of events pass and time does not.",
		columns);
	size_t count = states_rivals_gases(false, (struct step_gas[MOST_STEP_GASES]){0});
	for (size_t g = 0; g < count; g++) {
		const struct step_gas_outcome *outcome = &outcomes[g];
		if (!outcome->begun) continue;
		char text[200], command[320];
		step_gas_command(&gases[g], seed, command);
		table_row(table);
		table_text(table, "%s", gases[g].method);
		table_text(table, "%s", step_gas_name(&gases[g]));
		table_text(table, "%s", gases[g].arithmetic);
		name_it(table, outcome);
		table_text(table, "%s", misreading_tell(earliest(&outcome->misreading), text));
		table_count(table, outcome->misreading.repeats);
		table_count(table, outcome->misreading.misses);
		table_count(table, outcome->misreading.events);
		table_text(table, "%s", command);
		bool paper = strcmp(gases[g].method, "positional") == 0 && strcmp(gases[g].arithmetic, "binary64") == 0;
		if (paper && gases[g].shoulder && !outcome->stopped) claim_stuck(result, &gases[g], outcome);
	}
	result_note(result,
				"stretch, nudge and last-event correct by 1024 roundoffs: of a distance, or of the time in which "
				"a particle flies as far. In the absolute form a time so small is lost as soon as the clock's own "
				"last bit is larger, at t = 2048 or so; then they go wrong as positional does.");
}
