/* A message for the user: where, what is wrong, what is allowed. */
#ifndef UNCROSS_MESSAGE_H
#define UNCROSS_MESSAGE_H

#include <stddef.h>

#include "state/fault.h"

struct message {
  char text[1024];
};

/* Writes printf-style text into the message. Always returns 0, for `return message_set(...)`. */
int message_set(struct message *message, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* "file:line:col: " and then the text; line and column count from 1. Always returns 0. */
int message_at(struct message *message, const char *file, size_t line, size_t column, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* Why the physics had to stop. Always returns 0. */
int message_fault(struct message *message, const struct fault *fault);

#endif
