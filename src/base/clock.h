/* Wall time. */
#ifndef UNCROSS_BASE_CLOCK_H
#define UNCROSS_BASE_CLOCK_H

/* Seconds since some fixed moment; never goes back. */
double clock_seconds(void);

#endif
