# The live page: the library without MPFR, its cases and the page's engine, compiled for the web.
LIVE     := cases/convection.yaml $(filter-out cases/convection.yaml,$(wildcard cases/*.yaml)) $(wildcard cases/stress/*.yaml)
web       = $(patsubst %.c,$(BUILD)/web/%.o,$(1))
WEB      := $(call web,lib/arithmetic.c $(wildcard lib/engine/*.c lib/overlap/*.c lib/scene/*.c) \
	$(patsubst %,lib/unit/%.c,short binary32 binary64 twin) verify/measure/three_body.c $(filter-out %/recipes.c,$(wildcard verify/live/*.c)))
WEBFLAGS := --target=wasm32-wasi -msimd128 -std=gnu17 -O3 $(WARNINGS) -ffp-contract=off -fno-math-errno

.PHONY: live live-test live-frames
live:
	@.ci/setup live
	@$(MAKE) --no-print-directory -j$(CORES) $(BUILD)/live.html
	@echo "built $(BUILD)/live.html ($$(du -k $(BUILD)/live.html | cut -f1) kB): open it in a browser"

# The page in a browser without a window; where there is none it is skipped, which is said.
live-test: $(BUILD)/live.html $(BUILD)/touchstone $(BUILD)/page_check $(BUILD)/page_scenes
	@for test in $(BUILD)/page_check $(BUILD)/page_scenes; do \
		if $$test $(BUILD)/touchstone $(BUILD)/live.html; then :; else told=$$?; [ $$told = 77 ] || exit $$told; fi; done

# How fast it draws, here and now: ROUNDS=3 of a minute each.
ROUNDS   := 3
live-frames: $(BUILD)/live.html $(BUILD)/page_frames
	@$(BUILD)/page_frames $< $(ROUNDS)

$(BUILD)/page_check $(BUILD)/page_scenes: verify/live/test/page.c
$(BUILD)/page_%: verify/live/test/page_%.c verify/live/test/browser.c $(wildcard verify/live/test/*.h)
	$(call say,link $@) $(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) -MF $@.d -o $@ $(filter %.c,$^) -lcmocka -lcurl -ljansson

$(BUILD)/live.html: $(BUILD)/live.wasm reports/live/assemble $(wildcard reports/live/*.*)
	$(call say,assemble $@) reports/live/assemble $< >$@.aside && mv $@.aside $@

$(BUILD)/live.wasm: $(WEB)
	$(call say,link $@) clang $(WEBFLAGS) -mexec-model=reactor -Wl,--strip-all -o $@ $^

$(BUILD)/web/%.o: %.c
	@mkdir -p $(@D)
	$(call say,compile $< for the web) clang $(WEBFLAGS) -Ilib -Iverify -I$(BUILD)/web -DTOUCHSTONE_WITHOUT_MPFR -D_GNU_SOURCE \
		-MMD -MP -c -o $@ $<

$(BUILD)/web/verify/live/live.o: $(BUILD)/web/recipes.inl
$(BUILD)/web/recipes.inl: $(BUILD)/web/recipes $(LIVE)
	$(call say,write $@) $< $(filter %.yaml,$^) >$@.aside && mv $@.aside $@

$(BUILD)/web/recipes: verify/live/recipes.c $(BUILD)/parts.a $(BUILD)/libtouchstone.a
	@mkdir -p $(@D)
	$(call say,link $@) $(CC) $(CPPFLAGS) $(CFLAGS) $(LDFLAGS) -MF $@.d -o $@ $(filter %.c %.a,$^) $(LDLIBS)
