#include "engine/sieve.h"

const struct sieve_machine *sieve_machine(size_t number)
{
#ifdef __x86_64__
	bool fair = __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
	bool fast = fair && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
				__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
	if (fast && number-- == 0) return &sieve_avx512;
	if (fair && number-- == 0) return &sieve_avx2;
#endif
	return number == 0 ? &sieve_any : NULL;
}
