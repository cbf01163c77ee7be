/* What is still to be made of a campaign, as those who make it see it: threads here, other ranks through courier.h.
 * Each function may be called by any thread. For the parts of the campaign only. */
#ifndef VERIFY_CAMPAIGN_WORK_H
#define VERIFY_CAMPAIGN_WORK_H

#include "campaign/campaign.h"

struct campaign_work;

enum { WORK_NONE = -1 };

/* Takes the next piece: its place among those that are missing, or WORK_NONE when there is none, or an end is asked
 * for.
 */
long work_take(struct campaign_work *work);

/* Its number in the campaign, and its key. */
size_t work_piece(const struct campaign_work *work, long at);
void work_key(const struct campaign_work *work, long at, char key[CAMPAIGN_KEY]);

/* Keeps what became of it: a result, which is taken over; an error; or neither, when it was stopped. */
void work_keep(struct campaign_work *work, long at, json_t *result, const char *error);

/* Whether an end is asked for; whether everything that was taken has come to something, and nothing is left to take. */
bool work_stopped(struct campaign_work *work);
bool work_over(struct campaign_work *work);

#endif
