#include "live/sequence.h"

#include <stdlib.h>
#include <string.h>

void sequence_clear(struct sequence *sequence)
{
	free(sequence->ahead);
	*sequence = (struct sequence){0};
}

/* Makes room for one more. */
static bool grow(struct sequence *sequence)
{
	if (sequence->count < sequence->room) return true;
	size_t room = sequence->room ? 2 * sequence->room : 1024;
	uint64_t *ahead = malloc(room * sizeof *ahead);
	if (!ahead) return false;
	for (size_t k = 0; k < sequence->count; k++) ahead[k] = sequence->ahead[(sequence->first + k) % sequence->room];
	free(sequence->ahead);
	sequence->ahead = ahead;
	sequence->first = 0;
	sequence->room = room;
	return true;
}

void sequence_enter(struct sequence *sequence, int side, const struct touchstone_event *event)
{
	if (sequence->differ) return;
	uint64_t word = (uint64_t)event->kind << 60 | (uint64_t)event->first << 30 | event->second;
	if (sequence->count == 0 || sequence->side == side) {
		sequence->differ = sequence->ended[!side] || !grow(sequence);
		if (sequence->differ) return;
		sequence->ahead[(sequence->first + sequence->count++) % sequence->room] = word;
		sequence->side = side;
		return;
	}
	sequence->differ = sequence->ahead[sequence->first] != word;
	if (sequence->differ) return;
	sequence->first = (sequence->first + 1) % sequence->room;
	sequence->count--;
	sequence->common++;
}

void sequence_end(struct sequence *sequence, int side)
{
	sequence->ended[side] = true;
	if (sequence->count && sequence->side != side) sequence->differ = true;
}
