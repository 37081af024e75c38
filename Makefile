# uncross: `make demo` runs the main job, `make check` the tests; `make help` lists the rest.

CC      ?= gcc
ifeq ($(origin CC),default)
CC      := gcc
endif
MARCH   ?= native
PREFIX  ?= /usr/local
BUILD   ?= build

# The same bits everywhere: no fused multiply-add, no optimisation that changes values. errno of sqrt and llrint is unused.
STRICT   := -std=c11 -ffp-contract=off -fno-math-errno -D_POSIX_C_SOURCE=200809L
OPTIMIZE ?= -O3 -march=$(MARCH)
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror
INCLUDES := -Isrc $(patsubst -I%,-isystem %,$(shell pkg-config --cflags-only-I hdf5 2>/dev/null))
CFLAGS   ?= -g
ALL_CFLAGS = $(STRICT) $(OPTIMIZE) $(WARNINGS) $(INCLUDES) $(CFLAGS)
LIBS      = $(shell pkg-config --libs hdf5 yaml-0.1 jansson libxxhash 2>/dev/null) -lm
TEST_LIBS = -lcmocka -lgsl -lgslcblas -lgmp

SOURCES := $(sort $(shell find src -name '*.c'))
OBJECTS := $(SOURCES:%.c=$(BUILD)/%.o)
LIBRARY := $(BUILD)/libuncross.a
TESTS   := $(sort $(shell find tests -name 'test_*.c' 2>/dev/null))
TEST_PROGRAMS := $(TESTS:%.c=$(BUILD)/%)

.PHONY: all
all: $(BUILD)/uncross

$(BUILD)/uncross: $(BUILD)/src/main.o $(LIBRARY)
	$(CC) $(ALL_CFLAGS) $^ $(LIBS) -o $@

$(LIBRARY): $(filter-out $(BUILD)/src/main.o,$(OBJECTS))
	rm -f $@
	ar rcs $@ $^

$(BUILD)/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -MMD -MP -c $< -o $@

$(BUILD)/tests/%: tests/%.c $(LIBRARY) Makefile
	@mkdir -p $(@D)
	$(CC) $(ALL_CFLAGS) -Itests -MMD -MP $< $(LIBRARY) $(TEST_LIBS) $(LIBS) -o $@

-include $(OBJECTS:.o=.d) $(TEST_PROGRAMS:=.d)

.PHONY: clean
clean:
	rm -rf $(BUILD)
