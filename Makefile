# Touchstone. `make` builds build/touchstone; `make report` and `make test` also install what is missing.
#
#   make report            the papers' figures at quick size, as pages in build/report
#   make test              all tests, most also under sanitizers, and the digests of other compilers and optimisations
#   make test-sanitize     all of them under sanitizers
#   make bench             what an event costs, held against the run before; FULL=1 for longer, STORE=1 to keep this run
#   make soak              an hour of looking for what is rare, SOAK=600 for ten minutes: kills of runs, campaigns and
#                          audits, the correctly rounded finder against the exact oracle, make fuzz, make valgrind
#   make valgrind          test programs, and what they start, under valgrind's memcheck: an hour of one core;
#                          MEMCHECK=900 for so many seconds in all, MEMCHECK_EACH=60 at most
#   make fuzz              coverage-guided fuzzing of finders and readers, SECONDS_EACH=60; FUZZER=afl for AFL++;
#                          verify/fuzz/coverage does the same, and ends with 77 where the fuzzer is missing
#   make CC=clang          another compiler               make BUILD=build/other   another place
#   make live              the scenes in a browser: build/live.html, one file; make live-test drives it in Chromium,
#                          make live-frames tells how fast it draws
#   make clean, make format

VERSION  := 0.1
BUILD    := build
# The build whose program is taken, but for the library.
AROUND   := $(BUILD)
CORES    := $(shell nproc)
BASELINE  = $(BUILD)/bench-baseline.json
CC       := gcc
OPTIMISE := -O3
WARNINGS := -Wall -Wextra -Wpedantic $(if $(CI),-Werror)
CFLAGS   := -std=gnu17 $(OPTIMISE) -g $(WARNINGS) -ffp-contract=off -fno-math-errno -fopenmp -Wno-psabi $(EXTRA)
CPPFLAGS := -Ilib -Iverify -Ireports -D_GNU_SOURCE -MMD -MP
# MPFR and GMP are linked in whole: calls into shared objects cost a long run 8 %.
LDLIBS   := -lhdf5_serial -lcyaml -lyaml -ljansson -lgsl -lgslcblas -lsqlite3 -l:libmpfr.a -l:libgmp.a -lm

sources   = $(shell find $(1) -name '*.c' -not -path '*/test/*' -not -path '*/soak/*' -not -path '*/mpi/*' \
	-not -path '*/target/*' -not -path '*/live/live.c' -not -path '*/live/recipes.c')
objects   = $(patsubst %.c,$(BUILD)/object/%.o,$(1))
MAIN     := verify/command/main.c
BENCH    := verify/bench/main.c
LIBRARY  := $(call objects,$(call sources,lib))
PARTS    := $(call objects,$(filter-out $(MAIN) $(BENCH),$(call sources,verify reports)))
TESTS    := $(patsubst %.c,$(BUILD)/%,$(shell find lib verify reports -path '*/test/*_test.c'))
# Tests that take more than two seconds under sanitizers, where `make test` leaves them out. Elsewhere they come first,
# so that no core waits for another in the end.
SLOW     := $(patsubst %,%_test,audit campaign_command campaign_kill chart engine family fuzz grade_command num_short oracle \
	oracle_rule physics plugin policy resume slack step_engine step_gas step_oracle time_place)
named     = $(foreach test,$(TESTS),$(if $(filter $(1),$(notdir $(test))),$(test)))
CHECKED   = $(filter-out $(call named,$(OMIT)),$(call named,$(SLOW)) $(filter-out $(call named,$(SLOW)),$(TESTS)))

# Campaigns on several machines: a module that is loaded by programs which mpirun launched, and by no others.
MPICC    := $(shell command -v mpicc)
MPI      := $(if $(MPICC),$(BUILD)/touchstone-mpi.so)

# Finders by others: the worked example, as C11 and as C++, and some that do everything wrong.
PLUGINS  := $(patsubst verify/test/plugins/%.c,$(BUILD)/plugins/%.so,$(wildcard verify/test/plugins/*.c)) \
	$(BUILD)/plugins/example_cxx.so

.PHONY: all report test bench check soak valgrind fuzz test-sanitize digests format clean
.DELETE_ON_ERROR:
.SECONDARY:

all: $(BUILD)/touchstone $(MPI)
	@echo "built $<; next: '$< list', '$< run cases/hard-spheres.yaml', 'make report' or 'make test'"

report:
	@.ci/setup report
	@$(MAKE) --no-print-directory -j$(CORES) $(BUILD)/touchstone
	$(BUILD)/touchstone reproduce all --results $(BUILD)/results
	$(BUILD)/touchstone report --results $(BUILD)/results --output $(BUILD)/report

test:
	@.ci/setup
	@$(MAKE) --no-print-directory -j$(CORES) $(BUILD)/touchstone $(TESTS)
	@$(MAKE) --no-print-directory check
	@$(MAKE) --no-print-directory -j2 digests live-test
	@$(MAKE) --no-print-directory test-sanitize OMIT='$(SLOW)' PLAIN='$(RARE)'

# Every test program, from this folder, as many at a time as there are cores; each tells its tale when it has ended.
check: $(BUILD)/touchstone $(CHECKED)
	@printf '%s\n' $(CHECKED) | OMP_WAIT_POLICY=passive xargs -P $(CORES) -n 1 sh -c \
		'if "$$0" >"$$0.log" 2>&1 </dev/null; then told=0; else told=1; fi; \
		echo "== $$0"; cat "$$0.log"; exit $$told'

# Valgrind is taken if it can be had; without it all but the instructions is measured.
bench:
	@.ci/setup report
	@.ci/setup bench || echo 'bench: instructions will not be counted'
	@$(MAKE) --no-print-directory -j$(CORES) $(BUILD)/touchstone $(BUILD)/bench
	$(BUILD)/bench --baseline $(BASELINE) --results $(BUILD)/results $(if $(FULL),--full) $(if $(STORE),--store)
	$(BUILD)/touchstone report --results $(BUILD)/results --output $(BUILD)/report

# A quarter of the time each, to kills, answers, fuzzers and memcheck; all are heard, and one finding is a failure.
SOAK     := 3600
SOAKERS  := $(addprefix $(BUILD)/verify/soak/,kill_soak kept_soak rounded_soak)
soak: $(BUILD)/touchstone $(SOAKERS)
	@status=0; share() { timeout --foreground --preserve-status -s INT "$$@" || status=1; }; \
	share $$(($(SOAK) / 8)) $(BUILD)/verify/soak/kill_soak 1000000; \
	share $$(($(SOAK) / 8)) $(BUILD)/verify/soak/kept_soak 1000000; \
	share $$(($(SOAK) / 4)) $(BUILD)/verify/soak/rounded_soak 1e15; \
	BUILD='$(BUILD)' MAKE='$(MAKE)' verify/fuzz/coverage libfuzzer $$(($(SOAK) / 4 / $(FUZZED))) || \
		[ $$? -eq 77 ] || status=1; \
	$(MAKE) --no-print-directory valgrind MEMCHECK=$$(($(SOAK) / 4)) AT_RANDOM=1 || status=1; \
	exit $$status

# Memory errors that sanitizers do not see, such as numbers that nobody has set. The slow tests first, or AT_RANDOM=1 where
# there may be no time for all; which those are is said.
MEMCHECK := 9000
MEMCHECK_EACH := 3600
valgrind:
	@.ci/setup
	@.ci/setup bench
	@$(MAKE) --no-print-directory -j$(CORES) prepared
	@verify/test/memcheck $(MEMCHECK) $(MEMCHECK_EACH) $(if $(AT_RANDOM),$$(shuf -e $(CHECKED)),$(CHECKED))

# Coverage-guided fuzzing of finders and readers, so many seconds each: by libFuzzer, or with FUZZER=afl by AFL++. Called
# alone, the script ends with 77 where the fuzzer is missing; make ends with 2 then.
SECONDS_EACH := 60
FUZZER   := libfuzzer
FUZZED   := $(words $(wildcard verify/fuzz/target/*.c))
fuzz:
	@BUILD='$(BUILD)' MAKE='$(MAKE)' verify/fuzz/coverage $(FUZZER) $(SECONDS_EACH)

# The same tests under AddressSanitizer and UndefinedBehaviorSanitizer; TOUCHSTONE_BRIEF shortens the longest. To
# optimise arithmetics that few of them use takes longer than it saves `make test`.
RARE     := mpfr2 mpfr4 mpfr16 binary128 extended twin
SANITIZE = BUILD=$(BUILD)/sanitize OPTIMISE=-O1 \
	EXTRA='-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer'
test-sanitize:
	@$(MAKE) --no-print-directory -j$(CORES) $(SANITIZE) prepared
	@TOUCHSTONE_BRIEF=1 $(MAKE) --no-print-directory $(SANITIZE) check

# One digest for both compilers and all optimisations. Of each compiler there is one whole program; in its second the
# library is another and the rest the same. mpfr:53 runs in the smallest of the MPFR units.
DIGEST_BUILD = $(MAKE) --no-print-directory -j$(CORES) EXTRA=-g0
digests: $(BUILD)/touchstone
	@$(DIGEST_BUILD) BUILD=$(BUILD)/plain OPTIMISE=-O0 AROUND=$(BUILD) $(BUILD)/plain/touchstone
	@$(DIGEST_BUILD) BUILD=$(BUILD)/clang-plain CC=clang OPTIMISE=-O0 $(BUILD)/clang-plain/touchstone
	@$(DIGEST_BUILD) BUILD=$(BUILD)/clang CC=clang AROUND=$(BUILD)/clang-plain PLAIN='mpfr4 mpfr16' $(BUILD)/clang/touchstone
	@verify/test/digests $(BUILD)/touchstone $(BUILD)/clang/touchstone $(BUILD)/plain/touchstone \
		$(BUILD)/clang-plain/touchstone

.PHONY: prepared
prepared: $(BUILD)/touchstone $(CHECKED)

# V=1 shows the whole commands.
say = @$(if $(V),,echo '  $(1)';)$(if $(V),set -x;)

$(BUILD)/touchstone: $(patsubst $(BUILD)/%,$(AROUND)/%,$(call objects,$(MAIN)))
$(BUILD)/bench: $(call objects,$(BENCH))
$(BUILD)/touchstone $(BUILD)/bench: $(AROUND)/parts.a $(BUILD)/libtouchstone.a
	$(call say,link $@) $(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDLIBS)

$(BUILD)/libtouchstone.a: $(LIBRARY)
$(BUILD)/parts.a: $(PARTS)
$(BUILD)/%.a:
	$(call say,archive $@) rm -f $@ && ar rcs $@ $^

$(BUILD)/object/%.o: %.c
	@mkdir -p $(@D)
	$(call say,compile $<) $(CC) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# What names the revision is compiled anew when there is another, and nothing else is.
REVISION := $(shell git describe --always --dirty 2>/dev/null)
NAMING   := $(patsubst %,$(BUILD)/object/verify/%.o,command/reproduce command/grade command/chart command/audit bench/main \
	campaign/piece_store)
$(NAMING): CPPFLAGS += -DTOUCHSTONE_REVISION='"$(REVISION)"'
$(NAMING): $(BUILD)/revision
.PHONY: always
$(BUILD)/revision: always
	@mkdir -p $(@D)
	@echo '$(REVISION)' | cmp -s - $@ || echo '$(REVISION)' >$@

# Where the cases are when there are none in the folder one works in.
cases_folder := -DTOUCHSTONE_CASES='"$(CURDIR)/cases"'
$(BUILD)/object/verify/command/cases.o: CPPFLAGS += $(cases_folder)

# Debian keeps HDF5's headers apart, one folder for each way of building it.
$(BUILD)/object/verify/store/checkpoint_tree.o: CPPFLAGS += -isystem /usr/include/hdf5/serial

# Templates and plot scripts are part of the program.
$(BUILD)/object/reports/page.o $(BUILD)/object/reports/junit.o: $(wildcard reports/templates/*)
$(BUILD)/object/reports/figure.o: $(wildcard reports/plots/*)

# One set of objects for the program, the archive and the shared library, which shows what touchstone.h declares.
# Measured by size and by the counts of each instruction: the code of binary64 and of the sieve is the same without.
$(LIBRARY): CFLAGS += -fPIC -fvisibility=hidden -fno-semantic-interposition

# Units that run too little to be worth optimising.
$(PLAIN:%=$(BUILD)/object/lib/unit/%.o): CFLAGS += -O0

$(call objects,$(MAIN)): CPPFLAGS += -DTOUCHSTONE_VERSION='"$(VERSION)"'

# The sieve's bound holds whether products and sums are fused or not; fused is faster.
$(call objects,$(wildcard lib/engine/sieve_*.c)): CFLAGS += -ffp-contract=fast

# gcc 12 vectorises double -> float -> double in pairs and drops the rounding on the way.
$(BUILD)/object/lib/unit/binary32.o: CFLAGS += -fno-tree-slp-vectorize

# gcc makes selections of vectors only where nobody minds floating-point traps; no value depends on it.
$(BUILD)/object/lib/finder/batch.o: CFLAGS += -fno-trapping-math

$(BUILD)/%_test: CPPFLAGS += -DTOUCHSTONE_PROGRAM='"$(BUILD)/touchstone"' -DTOUCHSTONE_PLUGINS='"$(BUILD)/plugins"' \
	-DTOUCHSTONE_BENCH='"$(BUILD)/bench"' -DTOUCHSTONE_MPI='"$(BUILD)/touchstone-mpi.so"' $(cases_folder)
$(BUILD)/%_test: %_test.c $(BUILD)/parts.a $(BUILD)/libtouchstone.a
	@mkdir -p $(@D)
	$(call say,link $@) $(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) -MF $@.d -o $@ $(filter %.c %.a,$^) $(LDLIBS) -lcmocka

# The planted faults are about the answers of the program that loads them.
$(BUILD)/verify/test/fuzz_test: LDFLAGS += -rdynamic

$(TESTS): | $(PLUGINS) $(BUILD)/bench $(MPI)

$(BUILD)/touchstone-mpi.so: verify/mpi/ranks_mpi.c verify/campaign/ranks.h
	@mkdir -p $(@D)
	$(call say,module $@) OMPI_CC='$(CC)' $(MPICC) -std=gnu17 -O2 $(WARNINGS) -shared -fPIC -Iverify -o $@ $<

# As a stranger would compile them: against lib/touchstone.h alone.
$(BUILD)/plugins/%.so: verify/test/plugins/%.c lib/touchstone.h
	@mkdir -p $(@D)
	$(call say,plug-in $@) gcc -std=c11 -O2 -Wall -Wextra -Wpedantic -Werror -shared -fPIC -Ilib -o $@ $< -lm

$(BUILD)/plugins/%_cxx.so: verify/test/plugins/%.c lib/touchstone.h
	@mkdir -p $(@D)
	$(call say,plug-in $@) g++ -x c++ -std=c++11 -O2 -Wall -Wextra -Wpedantic -Werror -shared -fPIC -Ilib -o $@ $< -lm

$(BUILD)/verify/soak/kill_soak $(BUILD)/verify/soak/kept_soak: CPPFLAGS += -DTOUCHSTONE_PROGRAM='"$(BUILD)/touchstone"'
$(BUILD)/verify/soak/%: verify/soak/%.c $(BUILD)/parts.a $(BUILD)/libtouchstone.a
	@mkdir -p $(@D)
	$(call say,link $@) $(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) -MF $@.d -o $@ $(filter %.c %.a,$^) $(LDLIBS)

$(BUILD)/target/%: verify/fuzz/target/%.c $(BUILD)/parts.a $(BUILD)/libtouchstone.a
	@mkdir -p $(@D)
	$(call say,link $@) $(CC) $(CPPFLAGS) $(CFLAGS) -fsanitize=fuzzer $(LDFLAGS) -MF $@.d -o $@ $(filter %.c %.a,$^) \
		$(LDLIBS)

include .ci/install.mk
include .ci/live.mk

format:
	clang-format -i $$(git ls-files '*.c' '*.h' '*.inl')

clean:
	rm -rf $(BUILD)

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)
