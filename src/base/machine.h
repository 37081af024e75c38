/*
 * What is taken for granted of the machine and of the compiler's flags, said in words where it does not hold. Nothing
 * is included: a machine that lacks it may lack headers too.
 */
#ifndef UNCROSS_BASE_MACHINE_H
#define UNCROSS_BASE_MACHINE_H

/* Hashes are of bytes in memory, and files hold them. */
#if !defined __BYTE_ORDER__ || __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "uncross needs a little-endian machine: its state hashes and its files are made of bytes in that order"
#endif

/* Products of lattice coordinates, and sums of energies, have up to 128 bits. */
#ifndef __SIZEOF_INT128__
#error "uncross needs a 64-bit machine: it computes with integers of 128 bits (leave out -m32)"
#endif

#if __FLT_EVAL_METHOD__ != 0 || __DBL_MANT_DIG__ != 53
#error "uncross needs doubles of IEEE 754 that are rounded after each operation (on x86: SSE2, not -mfpmath=387)"
#endif

#ifdef __FAST_MATH__
#error "uncross needs arithmetic in the order written, else results are others: leave out -Ofast and -ffast-math"
#endif

#endif
