/*
 * Inside the oracle: rounding to single precision. gcc 12 at -O3 -march=x86-64-v4 leaves (double)(float)x out of pairs
 * that it joins to vectors, so that x stayed a double, and the guess was not made. A volatile float is rounded whatever
 * the compiler does. Every guess in single precision is made with it.
 */
#ifndef UNCROSS_ORACLE_SINGLE_H
#define UNCROSS_ORACLE_SINGLE_H

static inline double single_of(double x)
{
  const volatile float rounded = (float)x;
  return (double)rounded;
}

#endif
