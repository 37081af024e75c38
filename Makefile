# uncross: `make demo` runs the main job, `make check` the tests; `make help` lists the rest.

CC       ?= gcc
MARCH    ?= native
PREFIX   ?= /usr/local
DESTDIR  ?=
BUILD    ?= build

LIBRARIES := hdf5 yaml-0.1 jansson libxxhash
OPTIMIZE ?= -O3 -march=$(MARCH)
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror
# The same bits everywhere: no fused multiply-add, no value-changing optimisation. errno of sqrt and llrint is not used.
STRICT   := -std=c11 -ffp-contract=off -fno-math-errno -D_POSIX_C_SOURCE=200809L
