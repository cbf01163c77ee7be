# make install and make uninstall: the program, the library for other people's programs, manual pages, completion.

PREFIX    := /usr/local
SONAME    := libtouchstone.so.$(firstword $(subst ., ,$(VERSION)))
SHARED    := libtouchstone.so.$(VERSION)
place      = $(DESTDIR)$(PREFIX)/$(1)
copy       = install -m 644 $(1) $(call place,$(2))

.PHONY: install uninstall

# Here MPFR and GMP are linked as shared objects, as programs that embed the library expect.
$(BUILD)/$(SHARED): $(LIBRARY)
	$(call say,link $@) $(CC) $(filter -fsanitize=%,$(CFLAGS)) $(LDFLAGS) -shared -Wl,-soname,$(SONAME) -Wl,--as-needed \
		-Wl,--strip-debug -o $@ $^ -lmpfr -lgmp -lm

# One object, in which names of our own can meet nobody else's.
$(BUILD)/embed/libtouchstone.a: $(LIBRARY)
	@mkdir -p $(@D)
	$(call say,archive $@) rm -f $@ && $(LD) -r -o $(@D)/touchstone.o $^ && \
		objcopy --localize-hidden --strip-debug $(@D)/touchstone.o && ar rcs $@ $(@D)/touchstone.o

$(BUILD)/man/made: $(BUILD)/touchstone .ci/manuals
	$(call say,manual pages) .ci/manuals $< $(@D) && touch $@

install: $(BUILD)/touchstone $(MPI) $(BUILD)/$(SHARED) $(BUILD)/embed/libtouchstone.a $(BUILD)/man/made
	install -d $(foreach folder,bin include lib/pkgconfig lib/touchstone share/man/man1 share/touchstone \
		share/bash-completion/completions,$(call place,$(folder)))
	install -m 755 $(BUILD)/touchstone $(call place,bin/touchstone)
	$(if $(MPI),$(call copy,$(MPI),lib/touchstone/touchstone-mpi.so))
	install -m 755 $(BUILD)/$(SHARED) $(call place,lib/$(SHARED))
	ln -sf $(SHARED) $(call place,lib/$(SONAME))
	ln -sf $(SONAME) $(call place,lib/libtouchstone.so)
	$(call copy,$(BUILD)/embed/libtouchstone.a,lib/libtouchstone.a)
	$(call copy,lib/touchstone.h,include/touchstone.h)
	printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$${prefix}/lib' 'includedir=$${prefix}/include' '' 'Name: touchstone' \
		'Description: Event-driven particle dynamics in many arithmetics' 'Version: $(VERSION)' \
		'Libs: -L$${libdir} -ltouchstone' 'Libs.private: -lmpfr -lgmp -lm' 'Cflags: -I$${includedir}' \
		>$(call place,lib/pkgconfig/touchstone.pc)
	rm -rf $(call place,share/touchstone/cases) && cp -R cases $(call place,share/touchstone/cases)
	for page in $(BUILD)/man/*.1; do test ! -e "$$page" || $(call copy,"$$page",share/man/man1); done
	$(call copy,verify/command/completion.bash,share/bash-completion/completions/touchstone)
	$(if $(DESTDIR),,ldconfig || true)

uninstall:
	rm -rf $(call place,share/touchstone) $(call place,lib/touchstone)
	rm -f $(foreach file,bin/touchstone include/touchstone.h lib/pkgconfig/touchstone.pc lib/libtouchstone.a \
		lib/libtouchstone.so lib/$(SONAME) lib/$(SHARED) share/man/man1/touchstone.1 \
		share/bash-completion/completions/touchstone,$(call place,$(file))) $(call place,share/man/man1/touchstone-*.1)
