/* Figures are made of pieces of campaigns, which wait in the figure's folder until it is whole. */
#ifndef VERIFY_FIGURE_CAMPAIGN_H
#define VERIFY_FIGURE_CAMPAIGN_H

#include "campaign/campaign.h"
#include "figure/figure.h"
#include "measure/course.h"

/* Runs a campaign as the figure is set up: campaign_run. */
json_t *figure_campaign_run(const struct campaign *campaign, const struct figure_setup *setup,
							char error[CAMPAIGN_ERROR]);

/* How far a piece is that runs an engine: figure_piece_report(), given this as the context of a struct watch, tells the
 * campaign. */
struct figure_piece {
	const struct campaign_watch *watch;
	double done, all; /* events */
};
void figure_piece_report(void *context, uint64_t more, const struct touchstone_status *now);

#endif
