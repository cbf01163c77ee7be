#include "command/live_links.h"

#include <string.h>

/* A name that ends in '*' stands for all that begin so. */
static const struct {
	const char *result, *title, *query;
} links[] = {
	{"fig3", "A gas of discs in double and in single precision, until they part", "scene=gas&length=60&aspect-ratio=1"},
	{"fig3", "Some spheres of the paper's gas", "scene=hard-spheres"},
	{"fig4", "Three balls meet within 10^-14: the stable rule goes on, the textbook halts",
	 "scene=three-body&method=stable&against=naive"},
	{"fig5", "Three balls meet within 10^-14: the stable rule goes on, the textbook halts",
	 "scene=three-body&method=stable&against=naive"},
	{"fig5", "Missed collisions in a dense scene, where contacts are less often exact",
	 "scene=convection&length=50&aspect-ratio=1&nitems=1241&arithmetic=short:16&against=guarded&speed=1"},
	{"fig7", "The ball comes to rest, and by the textbook's formula halts or does not",
	 "scene=bouncing-ball&method=stable&against=naive"},
	{"fig7", "A column of balls does the same", "scene=column&method=stable&against=naive"},
	{"ladder", "The same gas in 12 and in 53 bits",
	 "scene=gas&length=40&aspect-ratio=1&arithmetic=short:12&against=binary64"},
	{"horizon", "Double and single precision from the same start: the event at which they part is counted",
	 "scene=gas&length=40&aspect-ratio=1&arithmetic=binary64&against=binary32"},
	{"states", "Square wells: by what is remembered of pairs, and by what their positions say",
	 "scene=square-well&method=stable&against=positional&speed=3"},
	{"states", "Square shoulders, the same", "scene=square-shoulder&method=stable&against=positional&speed=3"},
	{"time-and-place", "Discs far from the origin, in double and in single precision", "scene=stress-far-away"},
	{"time-and-place", "A gas on a late clock, the same", "scene=stress-long-times"},
	{"grade*", "A finder that misses collisions: discs sink into one another",
	 "scene=convection&length=50&aspect-ratio=1&nitems=1000&arithmetic=short:12&against=guarded&speed=1"},
	{"grade*", "A finder that answers with a negative time", "scene=three-body&method=stable&against=naive"},
};

void live_links(struct result *result, const char *name)
{
	for (size_t k = 0; k < sizeof links / sizeof *links; k++) {
		size_t length = strlen(links[k].result);
		bool all = links[k].result[length - 1] == '*';
		if (all ? strncmp(links[k].result, name, length - 1) == 0 : strcmp(links[k].result, name) == 0)
			result_live(result, links[k].title, links[k].query);
	}
}
