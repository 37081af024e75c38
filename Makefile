# uncross: `make demo` runs the main job, `make check` the tests; `make help` lists the rest.

ifeq ($(origin CC),default)
CC := gcc
endif
# MARCH= (empty) is for every processor of a kind, as what is installed.
MARCH   ?= native
PREFIX  ?= /usr/local
LIBDIR  ?= $(PREFIX)/lib
BUILD   ?= build
# Warnings are errors where the sources are written, not where a newer compiler builds a tarball: `make dist` puts COMMIT there.
WERROR  ?= $(if $(wildcard COMMIT),,-Werror)

# The same bits everywhere: no fused multiply-add, no optimisation that changes values. Nobody looks at errno of sqrt and
# llrint, nor at the flags of floating-point exceptions, which loops that vectorise may raise more often.
STRICT   := -std=c11 -ffp-contract=off -fno-math-errno -fno-trapping-math -D_POSIX_C_SOURCE=200809L
OPTIMIZE ?= -O3$(MARCH:%= -march=%)
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla $(WERROR)
INCLUDES := -Isrc -Iinclude $(patsubst -I%,-isystem %,$(shell pkg-config --cflags-only-I hdf5 2>/dev/null))
CFLAGS   ?= -g
# What is written over by mistake ends the program: canaries on the stack, checked copies, tables that are read-only.
HARDEN   ?= -fstack-protector-strong $(if $(filter -O1 -O2 -O3 -Os,$(OPTIMIZE)),-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
HARDEN_LINKED = -Wl,-z,relro,-z,now $(LDFLAGS)
# The objects of the program are the library's, too: they fit in at any address, and show what UNCROSS_API marks only.
LINKABLE := -fPIC -fvisibility=hidden
ALL_CFLAGS = $(STRICT) $(OPTIMIZE) $(WARNINGS) $(HARDEN) $(INCLUDES) -fstack-usage $(CPPFLAGS) $(CFLAGS) $(LINKABLE)
# What sanitizers leave out in kernels and tests, and what the fuzzer needs (see `sanitize`).
UNCHECKED :=
GUIDE     :=
# What a test itself computes is little: its compilation takes a quarter of the time.
TEST_CFLAGS = $(ALL_CFLAGS) $(UNCHECKED) -O1 -Itests
# The headers of a target, whether BUILD is given as a relative path or as an absolute one; no list can hold a path with a space.
DEPENDENCIES = -MMD -MP $(addprefix -MT ,$(sort $@ $(if $(word 2,$(CURDIR)),,$(abspath $@) $(patsubst $(CURDIR)/%,%,$(abspath $@)))))
LIBS     := $(shell pkg-config --libs hdf5 yaml-0.1 jansson libxxhash 2>/dev/null) -lm
TEST_LIBS = -lcmocka -lgsl -lgslcblas -lmpfr -lgmp

# Fast kernels (src/kernel): one source, an object for each instruction set of x86-64. PLAIN=1 leaves them out, and so do
# other processors: same results. Tests compare them with the plain kernel in either case.
MACHINE    := $(shell $(CC) -dumpmachine 2>/dev/null)
PLAIN      ?= $(if $(filter x86_64%,$(MACHINE)),,1)
KERNELS    := $(if $(filter x86_64%,$(MACHINE)),sse2 avx2 avx512)
FAST       := $(if $(PLAIN),,$(KERNELS))
sse2_FLAGS := -msse2
avx2_FLAGS := -mavx2
avx512_FLAGS := -mavx512f -mavx512dq -mavx512vl
# For tests alone: the lanes of AVX2 and of AVX-512 on processors that have neither.
WIDE       := four eight
four_FLAGS := -DLANES=4 -Wno-psabi
eight_FLAGS := -DLANES=8 -Wno-psabi

SOURCES := $(filter-out src/kernel/solvent.c src/kernel/$(if $(PLAIN),rows,none).c,$(sort $(shell find src -name '*.c')))
OBJECTS := $(SOURCES:%.c=$(BUILD)/%.o) $(FAST:%=$(BUILD)/src/kernel/%.o)
LIBRARY := $(BUILD)/everything.a
TESTS   := $(sort $(shell find tests -name 'test_*.c'))
TEST_PROGRAMS    := $(TESTS:%.c=$(BUILD)/%)
STRESS           := $(sort $(wildcard tests/stress/stress_*.c))
STRESS_PROGRAMS  := $(STRESS:%.c=$(BUILD)/%)
MEASURES         := $(sort $(wildcard validation/measure/*.c))
MEASURE_PROGRAMS := $(MEASURES:%.c=$(BUILD)/%)
BENCHES          := $(sort $(wildcard validation/bench/*.c))
BENCH_PROGRAMS   := $(BENCHES:%.c=$(BUILD)/%)

.PHONY: all
all: $(BUILD)/uncross

.PHONY: help
help:
	@echo 'make                 builds $(BUILD)/uncross'
	@echo 'make demo            installs what it needs, builds, runs the paper'\''s semidilute system for a minute, writes a page'
	@echo 'make check           installs what it needs, builds, runs all tests'
	@echo 'make mutants         plants bugs in a copy of the sources, one at a time, and runs the tests that should see them'
	@echo 'make counts          instructions of each stage against a table; nothing is done that a scene does not need'
	@echo 'make counts-baseline writes that table anew (tests/counts/baseline.txt), and the one of docs/speed.md'
	@echo 'make judge-power     what `uncross oracle judge` makes of codes with planted bugs (twelve minutes)'
	@echo 'make stress          long runs: exact audit, linking numbers, 10^7 steps (half an hour)'
	@echo 'make cross           the program for aarch64 under emulation gives the same bits (ten minutes; part of stress)'
	@echo 'make lint            formatting, warnings of gcc and clang, static checks, include floors, equation table'
	@echo 'make port            the ports to NumPy and to all cores (ports/numpy, ports/parallel): oracle check, fresh packs and traces, planted bugs'
	@echo 'make measure         builds the programs behind docs/accuracy.md'
	@echo 'make bench           speed, scenes, scaling, run time against error: build/bench/bench.json; BENCH=speed,... chooses sections'
	@echo 'make bench-docs      the same, and its tables and figures into docs/'
	@echo 'make bench-peers     against Debian'\''s LAMMPS, in turn: build/bench/peers.json'
	@echo 'make bench-rivals    noncrossing fibers beside LAMMPS'\'' repulsive bonds and beads, at equal error (two hours): docs/claims/rivals.md'
	@echo 'make bench-error     run time against error: CPU time to 1 % by time step, rule, thermostat, medium (a quarter of an hour): docs/claims/settings.md'
	@echo 'make peer            the solvent'\''s memory and diffusion beside LAMMPS (a quarter of an hour): reference-data/campaign/peer'
	@echo 'make validate        the paper'\''s claims on reduced systems (seven minutes): build/validate/report.html'
	@echo 'make -j2 campaign    the same on the paper'\''s own systems, for hours or days; resumes; reference-data/campaign/'
	@echo 'make validate-planted   bugs of the physics planted in a copy: each turns a claim red'
	@echo 'make slurm-test      the campaign as a job array, on a Slurm that the test starts and stops (three minutes)'
	@echo 'make sanitize        the exact tests and short runs with sanitizers, and what of src/ they reach: build/sanitize/reached/index.html'
	@echo 'make fuzz            the fuzzer of scenes, checkpoints, trajectories, packs and tables, for SECONDS=60'
	@echo 'make libraries       libuncross.so, libuncross.a, libuncross-core.a in $(BUILD)/lib (docs/library.md)'
	@echo 'make live            the page: the same C code as WebAssembly, files for any server, in $(BUILD)/live (docs/live.md)'
	@echo 'make live-test       the page in Node and in headless Chromium: the native hashes, messages, tables; speed'
	@echo 'make install         PREFIX=$(PREFIX) LIBDIR=$(LIBDIR) DESTDIR=$(DESTDIR); for every processor, unless MARCH is given; make uninstall removes it'
	@echo 'make dist            the tarball that packages are made of: $(BUILD)/dist'
	@echo 'make packages        those packages, optimized little, and the binary interface, are checked: a stage of CI'
	@echo 'make npm             the library of the page as an npm package: $(BUILD)/npm'
	@echo 'make deb             Debian packages, looked at by lintian: $(BUILD)/deb'
	@echo 'make site            documents, interfaces, changelog and the live page as one folder of static files: $(BUILD)/site; LIVE= leaves the live page out'
	@echo 'make site-test       its links, and each page in headless Chromium on a phone and a desktop: width, other hosts, console, axe-core'
	@echo 'make clean           removes $(BUILD)'
	@echo 'variables            CC=gcc|clang  MARCH=native|x86-64|...  BUILD=folder  PLAIN=1 (no fast kernels, same results)'

# --- program and library ----------------------------------------------------------------------------------------------

TOP := $(BUILD)/src/cli/main.o

# Commands that other programs do: src/cli/outer.c looks for them beside the program.
OUTER   := uncross-check uncross-map uncross-export uncross-plot uncross-sweep uncross-topology uncross-name
HELPERS := $(OUTER:%=$(BUILD)/libexec/%)
$(HELPERS): $(BUILD)/libexec/%:
	@mkdir -p $(@D)
	@ln -sfn '$(CURDIR)/tools/$*' $@

$(BUILD)/uncross: $(TOP) $(LIBRARY) | $(HELPERS)
	@echo '  LD $@'
	@$(CC) $(ALL_CFLAGS) $(HARDEN_LINKED) $^ $(LIBS) -o $@

# What is missing is said once, before anything is compiled; copies of the sources without tools/ take it for granted.
$(BUILD)/found-%: $(wildcard tools/find-libraries)
	@mkdir -p $(@D)
	@$(if $<,$< $* $(CC) $(OPTIMIZE) $(CFLAGS))
	@touch $@

# All rooms, with everything visible: for the program and the tests.
$(LIBRARY): $(filter-out $(TOP),$(OBJECTS))
	@rm -f $@
	@ar rcs $@ $^

# Objects of another compiler, or for another processor, are made anew.
ifneq ($(file <$(BUILD)/made-by),$(CC) $(OPTIMIZE))
$(BUILD)/made-by: force
endif
$(BUILD)/made-by: | $(BUILD)/found-run
	@echo '$(CC) $(OPTIMIZE)' >$@

$(BUILD)/%.o: %.c Makefile $(BUILD)/made-by | $(BUILD)/found-run
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(ALL_CFLAGS) $(DEPENDENCIES) -c $< -o $@

# Whatever OPTIMIZE asks for, of the processor a kernel may only use what its name says.
KERNEL_CFLAGS = $(filter-out -march=% -mtune=%,$(ALL_CFLAGS)) $(UNCHECKED) -march=x86-64 $($*_FLAGS) -DKERNEL=kernel_$* -DKERNEL_NAME='"$*"'

$(patsubst %,$(BUILD)/src/kernel/%.o,$(KERNELS) $(WIDE)): $(BUILD)/src/kernel/%.o: src/kernel/solvent.c Makefile $(BUILD)/made-by | $(BUILD)/found-run
	@mkdir -p $(@D)
	@echo '  CC $< ($*)'
	@$(CC) $(KERNEL_CFLAGS) $(DEPENDENCIES) -c $< -o $@

# --- libraries to link (docs/library.md) ------------------------------------------------------------------------------

INTERFACE := $(shell sed -n 's/^.define UNCROSS_INTERFACE \([0-9]*\)$$/\1/p' include/uncross.h 2>/dev/null)
VERSION   := $(shell sed -n 's/^.define UNCROSS_VERSION "\(.*\)"$$/\1/p' src/version.h)
SONAME    := libuncross.so.$(INTERFACE)
SYMBOLS   := src/api/symbols.map
LIBRARIES := $(addprefix $(BUILD)/lib/,libuncross.so libuncross.a libuncross-core.a)

# Rooms without files: they need the C library and xxHash only.
CORE_ROOMS   := base system wall mpc fluid medium fiber contact bead kernel topology theory start observe
CORE_SOURCES := $(filter src/step.c src/work.c $(CORE_ROOMS:%=src/%/%),$(SOURCES))
CORE_HEADERS := $(filter src/step.h src/work.h $(CORE_ROOMS:%=src/%/%),$(sort $(shell find src -name '*.h')))

# What prints stays outside.
LINKED_OBJECTS := $(filter-out $(BUILD)/src/cli/% $(BUILD)/src/oracle/% $(BUILD)/src/files/info.o,$(OBJECTS))

.PHONY: libraries
libraries: $(LIBRARIES)

# The library reads HDF5 files by the program, of the same build.
$(BUILD)/lib/$(SONAME): $(LINKED_OBJECTS) $(SYMBOLS) | $(BUILD)/uncross
	@mkdir -p $(@D)
	@echo '  LD $@'
	@$(CC) $(ALL_CFLAGS) $(HARDEN_LINKED) -shared -Wl,-soname,$(SONAME),--version-script=$(SYMBOLS) $(filter %.o,$^) $(LIBS) -o $@

$(BUILD)/lib/libuncross.so: $(BUILD)/lib/$(SONAME)
	@ln -sf $(SONAME) $@

# One object whose other names are local, so that they cannot meet those of a program.
$(BUILD)/lib/libuncross.a: $(LINKED_OBJECTS) | $(BUILD)/uncross
	@mkdir -p $(@D)
	@echo '  LD $@'
	@$(CC) -r -nostdlib $^ -o $(BUILD)/lib/uncross.o
	@objcopy --localize-hidden $(BUILD)/lib/uncross.o
	@rm -f $@
	@ar rcs $@ $(BUILD)/lib/uncross.o

$(BUILD)/lib/libuncross-core.a: $(CORE_SOURCES:%.c=$(BUILD)/%.o) $(FAST:%=$(BUILD)/src/kernel/%.o)
	@mkdir -p $(@D)
	@rm -f $@
	@ar rcs $@ $^

# --- the page (docs/live.md) ------------------------------------------------------------------------------------------

.PHONY: live
live: $(BUILD)/uncross
	@$(MAKE) --no-print-directory -f live/Makefile BUILD='$(BUILD)' STRICT='$(STRICT)' CORE_SOURCES='$(CORE_SOURCES)' ALL_SOURCES='$(SOURCES)'

.PHONY: live-test
live-test:
	@tools/install-dependencies run live
	@$(MAKE) --no-print-directory live
	@node tests/live/bits.mjs $(BUILD)
	@$(MAKE) --no-print-directory npm
	@node tests/live/package.mjs $(BUILD)
	@node tests/live/page.mjs $(BUILD)

# --- the site ---------------------------------------------------------------------------------------------------------

# The documents as they are, both interfaces and the live page, as one folder of static files. LIVE= leaves the live page out.
LIVE ?= 1
.PHONY: site
site:
	@tools/install-dependencies run site $(if $(LIVE),live)
	@$(MAKE) --no-print-directory libraries $(if $(LIVE),live)
	@site/build '$(BUILD)' '$(VERSION)' $(LIVE)

.PHONY: site-test
site-test: site
	@tests/site/links $(BUILD)/site
	@node tests/site/pages.mjs $(BUILD)

# Written anew only when it says something new, so that nothing is rebuilt for nothing; two makes at a time may both write it.
$(BUILD)/build-info.inc: export PREFIX := $(PREFIX)
$(BUILD)/build-info.inc: force | $(BUILD)/found-run
	@[ "$$(printf %s "$$PREFIX" | wc -l)" = 0 ] || { echo 'uncross: PREFIX has a line feed in it, which no list of files can hold' >&2; exit 1; }
	@mkdir -p $(@D)
	@new=$@.$$$$; { echo '#define BUILD_COMMIT "$(shell cat COMMIT 2>/dev/null || git describe --always --dirty --abbrev=12 2>/dev/null || echo unknown)"'; \
	   echo '#define BUILD_COMPILER "$(shell $(CC) --version | head -n 1)"'; \
	   echo '#define BUILD_FLAGS "$(STRICT) $(OPTIMIZE)"'; \
	   printf '#define BUILD_PREFIX "%s"\n' "$$(printf %s "$$PREFIX" | sed 's/[\"]/\\&/g')"; } > $$new; \
	if cmp -s $$new $@; then rm $$new; else mv $$new $@; fi
$(BUILD)/src/files/build_info.o: $(BUILD)/build-info.inc
$(BUILD)/src/files/build_info.o: INCLUDES += -I$(BUILD)

.PHONY: force
force:

# What is installed, one line each: mode (or link), where it comes from, where it goes below $(PREFIX). @LIB@ is LIBDIR, seen from there.
FRONT     := $(wildcard *.md LICENSE NOTICE CITATION.cff codemeta.json)
DOCUMENTS := $(FRONT) $(shell find docs scenes examples -type f -not -path '*/.*' -not -name '*.pyc' 2>/dev/null)
# What `uncross oracle judge` holds a port against, and the table that a run makes for it (docs/judging.md).
JUDGED    := $(wildcard reference-data/README.md reference-data/observables.csv reference-data/measure-observables reference-data/judge/*.yaml reference-data/judge/power/*)
# What `uncross oracle check` holds a port against.
REFERENCE := $(wildcard $(foreach n,pack.h5 pack.txt.gz start.h5 start.txt.gz trace.csv yaml,reference-data/*.$(n) reference-data/flow/*.$(n) reference-data/dumbbells/*.$(n) reference-data/media/*.$(n) reference-data/tubes/*.$(n) reference-data/beads/*.$(n) reference-data/topology/*.$(n)))
define INSTALLED
755 $(BUILD)/uncross bin/uncross
$(foreach p,$(OUTER),755 tools/$(p) libexec/uncross/$(p)
)
644 tools/uncross_place.py libexec/uncross/uncross_place.py
644 include/uncross.h include/uncross.h
755 $(BUILD)/lib/$(SONAME) @LIB@/$(SONAME)
link $(SONAME) @LIB@/libuncross.so
644 $(BUILD)/lib/libuncross.a @LIB@/libuncross.a
644 $(BUILD)/lib/libuncross-core.a @LIB@/libuncross-core.a
$(foreach h,$(CORE_HEADERS),644 $(h) include/uncross-core/$(h:src/%=%)
)
644 $(BUILD)/install/uncross.pc @LIB@/pkgconfig/uncross.pc
644 $(BUILD)/install/uncross-core.pc @LIB@/pkgconfig/uncross-core.pc
644 $(BUILD)/install/completion share/bash-completion/completions/uncross
644 include/uncross.h lib/python3/dist-packages/uncross/uncross.h
$(foreach f,$(wildcard python/uncross/*.py python/uncross_export/*.py python/uncross_units/*.py python/uncross_plot/*.py python/uncross_plot/*.jinja python/uncross_sweep/*.* python/uncross_topology/*.py python/uncross_name/*.py),644 $(f) lib/python3/dist-packages/$(f:python/%=%)
)
$(foreach f,$(DOCUMENTS) $(REFERENCE) $(JUDGED) $(wildcard mistakes/*.yaml) $(wildcard ports/numpy/uncross_port/*.py ports/numpy/uncross_port/*.json),$(if $(filter $(f),$(RUNNABLE)),755,644) $(f) share/uncross/$(f)
)
endef
INSTALL_FILES = $(addprefix $(BUILD)/install/,uncross.pc uncross-core.pc man completion)
RUNNABLE := $(shell find docs examples reference-data/measure-observables -type f -executable 2>/dev/null)

# A prefix may hold any characters that a folder's name may, so only shells see it.
install uninstall $(BUILD)/install/%.pc: export DESTDIR := $(DESTDIR)
install uninstall $(BUILD)/install/%.pc: export PREFIX := $(PREFIX)
install uninstall $(BUILD)/install/%.pc: export LIBDIR := $(LIBDIR)
install: export INSTALLED := $(INSTALLED)

# LIBDIR seen from PREFIX, in a shell: $$lib.
LIB_BELOW = lib=$${LIBDIR\#"$$PREFIX"/}; \
  case /$$lib/ in //* | */../* | *[!A-Za-z0-9._+/-]*) echo 'uncross: LIBDIR is a folder below PREFIX, of letters, digits and . _ + - / below it' >&2; exit 1 ;; esac

.PHONY: install
ifeq ($(origin MARCH),file)
# A build of its own that is not tied to this processor; the fast kernels are chosen when it runs (src/kernel/choose.c).
install:
	@$(MAKE) --no-print-directory install MARCH= WERROR= BUILD='$(BUILD)/portable'
else
install: $(BUILD)/uncross $(LIBRARIES) $(INSTALL_FILES)
	@$(LIB_BELOW); { echo "$$INSTALLED" | sed "s|@LIB@|$$lib|"; \
	   for page in $(BUILD)/install/man/*; do echo "644 $$page share/man/man1/$${page##*/}"; done; } | tools/install-files install "$$DESTDIR$$PREFIX"
	@echo "installed in $$DESTDIR$$PREFIX"
endif

# Removes what install put there, and the folders that it made if they are empty then.
.PHONY: uninstall
uninstall:
	@tools/install-files uninstall "$$DESTDIR$$PREFIX"

# A page for the program and one for each command.
$(BUILD)/install/man: $(BUILD)/uncross
	@rm -rf $@
	@mkdir -p $@.new
	@$< help --man >$@.new/uncross.1
	@$< help --commands | while read -r name action; do $< help --man $$name $$action >"$@.new/uncross-$$name$${action:+-$$action}.1"; done
	@mv $@.new $@

$(BUILD)/install/completion: $(BUILD)/uncross
	@mkdir -p $(@D)
	@$< help --completion >$@

# The prefix may be another one at every install.
$(BUILD)/install/%.pc: tools/%.pc.in force
	@mkdir -p $(@D)
	@$(LIB_BELOW); sed "s|@LIB@|$$lib|; s|@PREFIX@|$$(printf %s "$$PREFIX" | sed 's/[\"$$#]/\\&/g; s/[\|&]/\\&/g')|; s|@VERSION@|$(VERSION)|" $< >$@

# --- packages (packaging/README.md) -------------------------------------------------------------------------------------

# What all packages are made of: the files of HEAD, and its name in COMMIT. The same bytes whenever it is made.
DIST := $(BUILD)/dist/uncross-$(VERSION).tar.gz
.PHONY: dist
dist:
	@mkdir -p $(BUILD)/dist
	@git -c tar.umask=0022 archive --format=tar --prefix=uncross-$(VERSION)/ \
	   --add-virtual-file="uncross-$(VERSION)/COMMIT:$$(git describe --always --abbrev=12)" -o $(DIST:.gz=) HEAD && gzip -9nf $(DIST:.gz=)
	@[ -z "$$(git status --porcelain)" ] || echo 'dist: uncommitted changes are not in it'
	@sha256sum $(DIST)

.PHONY: deb
deb: dist
	tools/install-dependencies run deb
	packaging/make-deb $(DIST) $(BUILD)/deb

# In CI: packages as `make deb` makes them, but optimized little, as most of the time is the compiler's; the interface. Installed in a bare root: `make stress`.
.PHONY: packages
packages: dist
	tools/install-dependencies run packages
	DEB_BUILD_OPTIONS='noopt noautodbgsym' packaging/make-deb $(DIST) $(BUILD)/deb-quick
	packaging/try-debs $(BUILD)/deb-quick
	$(MAKE) -j2 $(BUILD)/lib/$(SONAME)
	tools/abi check $(BUILD)/lib/$(SONAME)

# The page's library for other programs in JavaScript.
.PHONY: npm
npm: live
	@rm -rf $(BUILD)/npm
	@mkdir -p $(BUILD)/npm/package
	@sed 's|@VERSION@|$(VERSION)|' packaging/npm/package.json.in >$(BUILD)/npm/package/package.json
	@cp packaging/npm/index.js packaging/npm/README.md LICENSE $(BUILD)/live/library.js $(BUILD)/live/uncross.wasm $(BUILD)/live/uncross-simd.wasm $(BUILD)/npm/package
	@cd $(BUILD)/npm/package && npm pack --silent --pack-destination ..

# --- tests, checks, demo ----------------------------------------------------------------------------------------------

# Programs that are linked with all rooms read HDF5 files by a process of their own kind (src/files/reader.h).
READER := $(BUILD)/tests/reader.o

$(BUILD)/tests/%: tests/%.c $(READER) $(LIBRARY) Makefile | $(BUILD)/found-test
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(TEST_CFLAGS) $(DEPENDENCIES) $< $(READER) $(LIBRARY) $(TEST_LIBS) $(LIBS) -o $@

# Tests of the public interface see nothing else: they are linked with the shared library.
$(BUILD)/tests/api/test_%: tests/api/test_%.c $(BUILD)/lib/libuncross.so Makefile | $(BUILD)/found-test
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(filter-out -Isrc,$(TEST_CFLAGS)) $(DEPENDENCIES) $< -L$(BUILD)/lib -Wl,-rpath,'$$ORIGIN/../../lib' -luncross -lcmocka -lm -o $@

# No file of the core needs HDF5, YAML or jansson: all of them are linked, whether used or not.
$(BUILD)/tests/api/test_core: tests/api/test_core.c $(BUILD)/lib/libuncross-core.a Makefile | $(BUILD)/found-test
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(TEST_CFLAGS) $(DEPENDENCIES) $< -Wl,--whole-archive $(BUILD)/lib/libuncross-core.a -Wl,--no-whole-archive \
	   -lcmocka -lxxhash -lm -o $@

# Holds all kernels against the plain one, whether the program has them or not.
ROWS := $(if $(KERNELS),$(BUILD)/src/kernel/rows.o) $(patsubst %,$(BUILD)/src/kernel/%.o,$(KERNELS) $(WIDE))
$(filter $(BUILD)/tests/kernel/% $(BUILD)/tests/contract/test_kernels,$(TEST_PROGRAMS)): $(BUILD)/%: %.c $(ROWS) $(READER) $(LIBRARY) Makefile | $(BUILD)/found-test
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(TEST_CFLAGS) $(DEPENDENCIES) $(filter %.c %.o %.a,$^) $(TEST_LIBS) $(LIBS) -o $@

# Memory, files and HDF5 that fail on demand (tests/faults/inject.h): the program, and the tests of tests/faults.
INJECTOR := $(BUILD)/tests/faults/inject.o
INJECT    = $(INJECTOR) $$(nm $(INJECTOR) | sed -n 's/.* T __wrap_/-Wl,--wrap=/p')
$(INJECTOR): INCLUDES += -Itests

$(BUILD)/uncross-faults: $(TOP) $(LIBRARY) $(INJECTOR)
	@echo '  LD $@'
	@$(CC) $(ALL_CFLAGS) $(TOP) $(INJECT) $(LIBRARY) $(LIBS) -o $@

$(BUILD)/tests/faults/test_%: tests/faults/test_%.c $(READER) $(LIBRARY) $(INJECTOR) Makefile | $(BUILD)/found-test
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(TEST_CFLAGS) $(DEPENDENCIES) $< $(READER) $(INJECT) $(LIBRARY) $(TEST_LIBS) $(LIBS) -o $@

$(BUILD)/validation/%: validation/%.c $(READER) $(LIBRARY) Makefile | $(BUILD)/found-test
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(ALL_CFLAGS) -Itests $(DEPENDENCIES) $< $(READER) $(LIBRARY) $(TEST_LIBS) $(LIBS) -o $@

# Benchmarks need nothing that the program does not need.
$(BUILD)/validation/bench/%: validation/bench/%.c $(READER) $(LIBRARY) Makefile | $(BUILD)/found-run
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(ALL_CFLAGS) -Itests $(DEPENDENCIES) $< $(READER) $(LIBRARY) $(LIBS) -o $@

.PHONY: tests
tests: $(BUILD)/uncross $(BUILD)/uncross-faults $(LIBRARIES) $(TEST_PROGRAMS) $(BENCH_PROGRAMS)

.PHONY: measure
measure:
	tools/install-dependencies run measure
	$(MAKE) -j2 measure-programs

.PHONY: measure-programs
measure-programs: $(MEASURE_PROGRAMS)

# What was measured before with the same programs is kept: an interrupted run goes on where it was.
# EFFORT=0.1 for a look.
EFFORT ?= 1
.PHONY: bench
bench:
	tools/install-dependencies run bench
	$(MAKE) -j2 bench-programs
	validation/bench/run --build $(BUILD) --effort $(EFFORT) $(if $(BENCH),--sections $(BENCH))

# The tables and figures of the documents, from what was measured.
.PHONY: bench-docs
bench-docs: bench
	validation/bench/run --build $(BUILD) --effort $(EFFORT) $(if $(BENCH),--sections $(BENCH)) --docs

.PHONY: bench-peers
bench-peers:
	tools/install-dependencies run bench peers
	$(MAKE) -j2 $(BUILD)/uncross
	validation/bench/peers --build $(BUILD)

# Not in CI: it installs Slurm, and starts one of its own.
.PHONY: slurm-test
slurm-test:
	tools/install-dependencies run slurm
	$(MAKE) -j2 $(BUILD)/uncross
	validation/slurm/test --build $(BUILD)

# The solvent beside another program: claim `peer`. Not in CI, which has no LAMMPS.
PEER         := validation/cases/peer
PEER_MEASURE := $(addprefix $(BUILD)/validation/measure/,solvent_vacf solvent_vacf_box_axes solvent_lammps)
.PHONY: peer
peer:
	tools/install-dependencies run measure validate peers
	$(MAKE) -j2 $(BUILD)/uncross $(PEER_MEASURE)
	@test "$$($(BUILD)/validation/measure/solvent_vacf 4 5 0.02 90 3 2 1 | tail -n 1)" != \
	   "$$($(BUILD)/validation/measure/solvent_vacf_box_axes 4 5 0.02 90 3 2 1 | tail -n 1)" || \
	   { echo 'peer: collisions no longer draw their axes with random_axes, which box_axes.c stands in for'; exit 1; }
	validation/run makefile peer --tier campaign --build $(BUILD) >$(BUILD)/peer.mk
	$(MAKE) -f $(BUILD)/peer.mk all
	validation/run harvest peer --tier campaign --build $(BUILD)

$(BUILD)/validation/measure/solvent_vacf_box_axes: validation/measure/solvent_vacf.c \
   $(BUILD)/$(PEER)/box_axes.o $(BUILD)/src/kernel/none.o $(LIBRARY)
	@mkdir -p $(@D)
	@echo '  CC $<'
	@$(CC) $(ALL_CFLAGS) -Itests $(DEPENDENCIES) $< $(BUILD)/$(PEER)/box_axes.o $(BUILD)/src/kernel/none.o -Wl,--wrap=random_axes $(LIBRARY) $(LIBS) -o $@

$(BUILD)/validation/measure/solvent_lammps: $(PEER)/solvent_lammps $(PEER)/solvent.lammps
	@mkdir -p $(@D)
	@cp $^ $(@D)

# Fibers that cannot cross beside LAMMPS' repulsive bonds and beads: claim `rivals`. Not in CI, which has no LAMMPS.
RIVALS         := validation/cases/rivals
RIVALS_PROGRAM := $(BUILD)/validation/measure/rivals
.PHONY: bench-rivals
bench-rivals:
	tools/install-dependencies run measure validate peers
	$(MAKE) -j2 $(BUILD)/uncross $(RIVALS_PROGRAM)
	$(MAKE) -j2 MARCH=x86-64 BUILD=$(BUILD)/rivals/x86-64 $(BUILD)/rivals/x86-64/uncross
	$(RIVALS)/plant $(BUILD)/rivals/plain 'forces left out'
	validation/run makefile rivals --tier campaign --build $(BUILD) >$(BUILD)/rivals.mk
	$(MAKE) -f $(BUILD)/rivals.mk all
	validation/run harvest rivals --tier campaign --build $(BUILD)
	$(RIVALS)/table

$(RIVALS_PROGRAM): $(addprefix $(RIVALS)/,rivals methods.py measures.py fibers.lammps)
	@mkdir -p $(@D)
	@cp $^ $(@D)

# Run time against error: claim `settings`. Not in CI: its times count beside each other, so runs are made one at a time.
.PHONY: bench-error
bench-error:
	tools/install-dependencies run measure validate
	$(MAKE) -j2 $(BUILD)/uncross $(BUILD)/validation/measure/shear_decay
	validation/run makefile settings --tier campaign --build $(BUILD) >$(BUILD)/settings.mk
	$(MAKE) -j1 -f $(BUILD)/settings.mk all
	validation/run harvest settings --tier campaign --build $(BUILD)
	validation/cases/settings/table

# The paper's claims (validation/README.md). Runs are targets of a fragment of make: what is finished is not run again,
# what was interrupted goes on. A run that fails is a claim that the report calls missing.
.PHONY: validate
validate:
	tools/install-dependencies run validate
	$(MAKE) -j2 validation-programs
	@mkdir -p $(BUILD)/validate
	validation/run makefile --build $(BUILD) >$(BUILD)/validate/runs.mk
	$(MAKE) -s -k -j2 -f $(BUILD)/validate/runs.mk || true
	validation/run report --build $(BUILD)

.PHONY: campaign
campaign:
	tools/install-dependencies run validate
	$(MAKE) validation-programs
	@mkdir -p $(BUILD)/campaign
	validation/run makefile --tier campaign --build $(BUILD) >$(BUILD)/campaign/runs.mk
	+$(MAKE) -s -k -f $(BUILD)/campaign/runs.mk || true
	validation/run harvest --tier campaign --build $(BUILD)
	validation/run report --tier campaign --build $(BUILD)

.PHONY: validate-planted
validate-planted:
	tools/install-dependencies run validate
	validation/planted --build $(BUILD)/planted

.PHONY: validation-programs
validation-programs: $(BUILD)/uncross $(MEASURE_PROGRAMS)

.PHONY: bench-programs
bench-programs: $(BUILD)/uncross $(BENCH_PROGRAMS)

# What needs packages asks for them first, then builds in a second make: pkg-config may only now be there.
.PHONY: check
check:
	tools/install-dependencies run test plot validate readers
	$(MAKE) -j2 tests
	tests/run $(BUILD)

.PHONY: stress
stress:
	tools/install-dependencies run test stress cross packages
	$(MAKE) -j2 stress-programs
	tests/run --stress $(BUILD)

# The program for another processor, under emulation: the same bits (tests/stress/stress_cross.sh).
.PHONY: cross
cross:
	tools/install-dependencies run test cross
	$(MAKE) -j2 $(BUILD)/uncross
	tests/run --stress $(BUILD) stress_cross

.PHONY: stress-programs
stress-programs: $(BUILD)/uncross $(BUILD)/uncross-faults $(STRESS_PROGRAMS)

.PHONY: lint
lint:
	tools/install-dependencies run test lint
	tools/lint

.PHONY: mutants
mutants:
	tools/install-dependencies run test
	tools/mutants --docs docs/mutants.md

# Instructions, counted by callgrind: of a build that every x86-64 machine of the last ten years makes alike. Where all is built so (.ci/run), it is that.
COUNTED := $(if $(filter x86-64-v3,$(MARCH)),$(BUILD),build/counts)
COUNTS  := CC=gcc BUILD=$(COUNTED) OPTIMIZE='-O3 -march=x86-64-v3' CFLAGS=-g $(COUNTED)/uncross
.PHONY: counts
counts:
	tools/install-dependencies run counts
	$(MAKE) -j2 $(COUNTS)
	tools/counts $(COUNTED)/uncross; counts=$$?; tools/gathers || counts=1; tools/skips $(COUNTED)/uncross && exit $$counts

.PHONY: counts-baseline
counts-baseline:
	tools/install-dependencies run counts
	$(MAKE) -j2 $(COUNTS)
	tools/counts $(COUNTED)/uncross --baseline
	tools/gathers --baseline
	tools/skips $(COUNTED)/uncross --docs docs/speed.md

.PHONY: judge-power
judge-power:
	tools/install-dependencies run test
	$(MAKE) -j2 $(BUILD)/uncross
	tools/judge-power --uncross $(BUILD)/uncross --build $(BUILD)/judge-power

# PORT_SHARE=30: mistakes of one pack and operator in 30, of others whenever the catalogue changes, and texts of few packs.
.PHONY: port
port:
	tools/install-dependencies run port
	$(MAKE) -j2 $(BUILD)/uncross
	ports/numpy/check-elementary
	ports/numpy/check $(BUILD)/uncross $(if $(PORT_SHARE),--share $(PORT_SHARE))
	ports/parallel/check $(BUILD)/uncross

.PHONY: demo
demo:
	tools/install-dependencies run demo
	$(MAKE) -j2 $(BUILD)/uncross
	tools/demo $(BUILD)/uncross $(BUILD)/demo

# The exact tests under other flags, in folders of their own. Physics tests are long and add nothing here; those of
# validation/, of packages, of names and of units run little but Python, or another build.
EXACT_TESTS := $(filter-out tests/physics/% tests/validation/% tests/stress/% tests/mutants/% tests/tools/% tests/packages/% \
   tests/oracle/test_name% tests/api/%.py tests/cli/test_memory.py tests/cli/test_units.py, \
   $(sort $(shell find tests -name 'test_*.c' -o -name 'test_*.py' -o -name 'test_*.sh')))
.PHONY: exact
exact: $(BUILD)/uncross $(BUILD)/uncross-faults $(LIBRARIES) $(patsubst %.c,$(BUILD)/%,$(filter %.c,$(EXACT_TESTS)))

# Long statistics, of code that other tests and the scenes reach here, too.
STATISTICS := tests/fluid/test_dumbbell_stress.c tests/contract/test_thermostats.c
# By clang, as `make check` builds by gcc: so the hashes and packs of the tests are those of two compilers. Its counters of what
# is reached are those of the source, whatever sanitizers add. -O1 takes a third of the time of -O0.
SANITIZE_CFLAGS := -gline-tables-only -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=all \
   -fprofile-instr-generate -fcoverage-mapping
# Of pointers in the kernels and in tests, the address sanitizer sees what is wrong. These checks would compile 35 s for each kernel, and a quarter of the time of each test.
SANITIZE_UNCHECKED := -fno-sanitize=null,alignment,object-size,pointer-overflow
# Rooms that read files tell the fuzzer, which is linked with the same objects, which way they took.
GUIDED := -fsanitize=fuzzer-no-link
$(addprefix $(BUILD)/,src/files/%.o src/scene/%.o src/oracle/%.o tests/fuzz/%.o): ALL_CFLAGS += $(GUIDE)
SANITIZED := CC=clang BUILD=build/sanitize OPTIMIZE=-O1 HARDEN= CFLAGS='$(SANITIZE_CFLAGS)' UNCHECKED='$(SANITIZE_UNCHECKED)' GUIDE='$(GUIDED)' \
   LIBS='$(LIBS) $(CURDIR)/build/sanitize/child.o -Wl,--wrap=_exit'
build/sanitize/child.o: tests/faults/child_reached.c
	@mkdir -p $(@D)
	@clang -O1 -c $< -o $@
.PHONY: sanitize
sanitize:
	tools/install-dependencies run hard
	$(MAKE) build/sanitize/child.o
	LLVM_PROFILE_FILE=/dev/null $(MAKE) -j2 $(SANITIZED) exact
	tools/sanitize build/sanitize $(filter-out $(STATISTICS),$(EXACT_TESTS))

# Inputs that find something new go to build/fuzz/corpus; what was found is a file crash-* there, which FUZZ=file runs again.
SECONDS ?= 60
# A scene may ask for any amount of memory: what it gets here is none above 64 MB, and it must bear that.
FUZZ_LIMITS := ASAN_OPTIONS=max_allocation_size_mb=64:allocator_may_return_null=1:quarantine_size_mb=8:suppressions=tests/fuzz/suppressed \
   LSAN_OPTIONS=suppressions=tests/fuzz/leaks:print_suppressions=0 LLVM_PROFILE_FILE=/dev/null
FUZZ    ?= -max_total_time=$(SECONDS) build/fuzz/corpus tests/fuzz/corpus
.PHONY: fuzz
fuzz:
	tools/install-dependencies run hard
	$(MAKE) build/sanitize/child.o
	LLVM_PROFILE_FILE=/dev/null $(MAKE) -j2 $(SANITIZED) build/sanitize/readers
	mkdir -p build/fuzz/corpus
	@folder=$$(mktemp -d -p /dev/shm fuzz-XXXX 2>/dev/null || mktemp -d -p build/fuzz) && trap "rm -r $$folder" EXIT && \
	 TMPDIR=$$folder $(FUZZ_LIMITS) build/sanitize/readers -artifact_prefix=build/fuzz/ -max_len=4096 -timeout=60 \
	   -rss_limit_mb=3000 -print_final_stats=1 $(FUZZ)

STANDING := -Wl,--wrap=apart_start,--wrap=apart_end,--wrap=apart_lost,--wrap=apart_shut,--wrap=apart_go_on
$(BUILD)/readers: $(BUILD)/tests/fuzz/fuzz_readers.o $(BUILD)/tests/fuzz/standing_reader.o $(LIBRARY)
	@echo '  LD $@'
	@$(CC) $(ALL_CFLAGS) -fsanitize=fuzzer $(STANDING) $^ $(LIBS) -o $@

.PHONY: clean
clean:
	rm -rf $(BUILD)

-include $(OBJECTS:.o=.d) $(wildcard $(BUILD)/tests/fuzz/*.d) $(ROWS:.o=.d) $(TEST_PROGRAMS:=.d) $(STRESS_PROGRAMS:=.d) $(MEASURE_PROGRAMS:=.d) $(BENCH_PROGRAMS:=.d)
