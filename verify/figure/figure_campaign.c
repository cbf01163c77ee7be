#include "figure/figure_campaign.h"

#include <math.h>

json_t *figure_campaign_run(const struct campaign *campaign, const struct figure_setup *setup,
							char error[CAMPAIGN_ERROR])
{
	return campaign_run(campaign,
						&(struct campaign_setup){.folder = setup->folder,
												 .this_revision = !setup->any_revision,
												 .threads = setup->threads,
												 .stop = setup->stop,
												 .progress = setup->progress,
												 .context = setup->context},
						error);
}

void figure_piece_report(void *context, uint64_t more, const struct touchstone_status *now)
{
	(void)now;
	struct figure_piece *piece = context;
	piece->done += (double)more;
	piece->watch->progress(piece->watch, fmin(1, piece->done / piece->all));
}
