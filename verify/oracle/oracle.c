/* The public questions: the filter first, the integers where it cannot tell. */
#include "oracle/oracle.h"
#include "oracle/exact.h"
#include "oracle/filter.h"
#include <math.h>
#include <stdlib.h>

static void surd_init(struct surd *surd)
{
	mpz_inits(surd->rational, surd->radicand, surd->divisor, NULL);
}

static void surd_clear(struct surd *surd)
{
	mpz_clears(surd->rational, surd->radicand, surd->divisor, NULL);
}

struct oracle *oracle_create(void)
{
	struct oracle *oracle = calloc(1, sizeof *oracle);
	if (!oracle) return NULL;
	for (int i = 0; i < 7; i++) mpz_init(oracle->number[i]);
	for (int i = 0; i < SCRATCH; i++) mpz_init(oracle->scratch[i]);
	mpz_inits(oracle->a, oracle->b, oracle->c, oracle->discriminant, oracle->digits, oracle->other_digits, NULL);
	surd_init(&oracle->first);
	surd_init(&oracle->second);
	mpfr_init2(oracle->rounded, DIGITS);
	return oracle;
}

void oracle_destroy(struct oracle *oracle)
{
	if (!oracle) return;
	for (int i = 0; i < 7; i++) mpz_clear(oracle->number[i]);
	for (int i = 0; i < SCRATCH; i++) mpz_clear(oracle->scratch[i]);
	mpz_clears(oracle->a, oracle->b, oracle->c, oracle->discriminant, oracle->digits, oracle->other_digits, NULL);
	surd_clear(&oracle->first);
	surd_clear(&oracle->second);
	mpfr_clear(oracle->rounded);
	free(oracle);
}

void oracle_force_exact(struct oracle *oracle, bool force)
{
	oracle->force_exact = force;
}

uint64_t oracle_exact_count(const struct oracle *oracle)
{
	return oracle->exact_count;
}

bool oracle_accepts(const struct oracle_query *query)
{
	static const int count[] = {
		[ORACLE_BALL_BALL] = 7, [ORACLE_BALL_LEAVE] = 7, [ORACLE_BALL_PLANE] = 4, [ORACLE_HALF_SPACE] = 2};
	for (int i = 0; i < count[query->shape]; i++)
		if (!isfinite(query->number[i])) return false;
	return true;
}

struct oracle_time oracle_solve(struct oracle *oracle, const struct oracle_query *query)
{
	struct oracle_time time = {.query = *query};
	if (oracle->force_exact || !filter_solve(query, &time)) {
		time.event = exact_solve(oracle, query, &oracle->first);
		time.estimate = (struct oracle_estimate){0, 0, INFINITY};
	}
	return time;
}

void oracle_signs(struct oracle *oracle, const struct oracle_query *query, int signs[ORACLE_SIGNS])
{
	if (oracle->force_exact || !filter_signs(query, signs)) exact_signs(oracle, query, signs);
	bool turned = query->shape == ORACLE_BALL_PLANE && query->plane.acceleration < 0;
	for (int s = 0; turned && s < ORACLE_SIGNS - 1; s++) signs[s] = -signs[s];
}

double oracle_round(struct oracle *oracle, const struct oracle_time *time, mpfr_rnd_t direction)
{
	double rounded;
	if (time->event == ORACLE_NEVER) return INFINITY;
	if (time->event == ORACLE_NOW) return 0;
	if (!oracle->force_exact && filter_round(&time->estimate, direction, &rounded)) return rounded;

	/* The leading digits, the last of which stands for all the rest, round as the time does. */
	long exponent;
	exact_solve(oracle, &time->query, &oracle->first);
	if (surd_digits(oracle, &oracle->first, DIGITS - 3, oracle->digits, &exponent)) {
		dyadic_shift(oracle->digits, 1);
		mpz_setbit(oracle->digits, 0);
		exponent--;
	}
	mpfr_set_z_2exp(oracle->rounded, oracle->digits, exponent, MPFR_RNDZ);
	return mpfr_get_d(oracle->rounded, direction);
}

int oracle_round_mpfr(struct oracle *oracle, mpfr_t result, const struct oracle_time *time, mpfr_rnd_t direction)
{
	if (time->event == ORACLE_LATER) {
		exact_solve(oracle, &time->query, &oracle->first);
		return surd_round(oracle, result, &oracle->first, direction);
	}
	if (time->event == ORACLE_NEVER)
		mpfr_set_inf(result, 1);
	else
		mpfr_set_zero(result, 1);
	return 0;
}

int oracle_compare(struct oracle *oracle, const struct oracle_time *first, const struct oracle_time *second)
{
	if (first->event != ORACLE_LATER || second->event != ORACLE_LATER) {
		int rank[] = {[ORACLE_NOW] = 0, [ORACLE_LATER] = 1, [ORACLE_NEVER] = 2};
		int difference = rank[first->event] - rank[second->event];
		return (difference > 0) - (difference < 0);
	}
	int order;
	if (!oracle->force_exact && filter_compare(&first->estimate, &second->estimate, &order)) return order;
	exact_solve(oracle, &first->query, &oracle->first);
	exact_solve(oracle, &second->query, &oracle->second);
	return surd_compare(oracle, &oracle->first, &oracle->second);
}

int oracle_compare_double(struct oracle *oracle, const struct oracle_time *time, double value)
{
	if (time->event == ORACLE_NEVER) return value < INFINITY;
	if (time->event == ORACLE_NOW) return (value < 0) - (value > 0);
	if (value <= 0) return 1;
	if (value == INFINITY) return -1;
	int order;
	const struct oracle_estimate exactly = {value, 0, 0};
	if (!oracle->force_exact && filter_compare(&time->estimate, &exactly, &order)) return order;
	exact_solve(oracle, &time->query, &oracle->first);
	return surd_compare_double(oracle, &oracle->first, value);
}
