/* A message for the user: where, what is wrong, what is allowed. */
#ifndef UNCROSS_BASE_MESSAGE_H
#define UNCROSS_BASE_MESSAGE_H

#include <stddef.h>

/* What it speaks of is wrong; could not be read, so that nothing is known of it; or could not be had for want of
 * memory, which is the same. */
enum message_kind { MESSAGE_WRONG, MESSAGE_UNREAD, MESSAGE_NO_MEMORY };

struct message {
  char text[1024];
  enum message_kind kind;
};

/* Writes printf-style text into the message, escaped as text_escape does (base/text.h): it may be shown anywhere. The
 * message itself may be among the arguments. Always returns 0, for `return message_set(...)`. */
int message_set(struct message *message, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same, of what could not be read. */
int message_unread(struct message *message, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The same, for want of memory. */
int message_no_memory(struct message *message, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* "file:line:col: " and then the text; line and column count from 1. Always returns 0. */
int message_at(struct message *message, const char *file, size_t line, size_t column, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

#endif
