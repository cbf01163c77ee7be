#include "measure/impact_json.h"

#include "campaign/campaign.h"

static uint64_t count_of(const json_t *json, const char *member)
{
	return (uint64_t)json_integer_value(json_object_get(json, member));
}

static json_t *counts_to_json(const uint64_t *counts, size_t count)
{
	json_t *list = json_array();
	for (size_t c = 0; c < count; c++) json_array_append_new(list, json_integer((json_int_t)counts[c]));
	return list;
}

static void counts_from_json(uint64_t *counts, size_t count, const json_t *list)
{
	for (size_t c = 0; c < count; c++) counts[c] = (uint64_t)json_integer_value(json_array_get(list, c));
}

static json_t *histogram_to_json(const struct impact_histogram *histogram)
{
	return json_pack("{s:o, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "bars",
					 counts_to_json(histogram->bar, 2 * IMPACT_REACH + 1), "below", (json_int_t)histogram->below,
					 "above", (json_int_t)histogram->above, "doublings_below",
					 counts_to_json(histogram->doubling[0], IMPACT_DOUBLINGS), "doublings_above",
					 counts_to_json(histogram->doubling[1], IMPACT_DOUBLINGS), "sum", campaign_number(histogram->sum),
					 "sum_of_squares", campaign_number(histogram->sum_of_squares), "least",
					 campaign_number(histogram->least), "most", campaign_number(histogram->most));
}

static struct impact_histogram histogram_from_json(const json_t *json)
{
	struct impact_histogram histogram = {
		.below = count_of(json, "below"),
		.above = count_of(json, "above"),
		.sum = campaign_value(json, "sum"),
		.sum_of_squares = campaign_value(json, "sum_of_squares"),
		.least = campaign_value(json, "least"),
		.most = campaign_value(json, "most"),
	};
	counts_from_json(histogram.bar, 2 * IMPACT_REACH + 1, json_object_get(json, "bars"));
	counts_from_json(histogram.doubling[0], IMPACT_DOUBLINGS, json_object_get(json, "doublings_below"));
	counts_from_json(histogram.doubling[1], IMPACT_DOUBLINGS, json_object_get(json, "doublings_above"));
	return histogram;
}

json_t *impact_to_json(const struct impact *impact)
{
	return json_pack("{s:i, s:I, s:I, s:o, s:o}", "bits", impact->bits, "count", (json_int_t)impact->count, "forced",
					 (json_int_t)impact->forced, "measured", histogram_to_json(&impact->measured), "exact",
					 histogram_to_json(&impact->exact));
}

struct impact impact_from_json(const json_t *json)
{
	if (!json_is_object(json)) return (struct impact){0};
	return (struct impact){
		.bits = (int)json_integer_value(json_object_get(json, "bits")),
		.count = count_of(json, "count"),
		.forced = count_of(json, "forced"),
		.measured = histogram_from_json(json_object_get(json, "measured")),
		.exact = histogram_from_json(json_object_get(json, "exact")),
	};
}
