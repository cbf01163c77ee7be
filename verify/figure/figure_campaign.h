/* Figures are made of pieces of campaigns, which wait in the figure's folder until it is whole. */
#ifndef VERIFY_FIGURE_CAMPAIGN_H
#define VERIFY_FIGURE_CAMPAIGN_H

#include "campaign/campaign.h"
#include "figure/figure.h"

/* Runs a campaign as the figure is set up: campaign_run. */
json_t *figure_campaign_run(const struct campaign *campaign, const struct figure_setup *setup,
							char error[CAMPAIGN_ERROR]);

#endif
