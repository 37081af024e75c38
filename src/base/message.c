#include "base/message.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/text.h"

/* Names and files of others are among the arguments, so all of the text is escaped. */
static int set(struct message *message, enum message_kind kind, const char *format, va_list arguments)
{
  char text[sizeof message->text];
  vsnprintf(text, sizeof text, format, arguments);
  text_escape(text, message->text, sizeof message->text);
  message->kind = kind;
  return 0;
}

int message_set(struct message *message, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  set(message, MESSAGE_WRONG, format, arguments);
  va_end(arguments);
  return 0;
}

int message_unread(struct message *message, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  set(message, MESSAGE_UNREAD, format, arguments);
  va_end(arguments);
  return 0;
}

int message_no_memory(struct message *message, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  set(message, MESSAGE_NO_MEMORY, format, arguments);
  va_end(arguments);
  return 0;
}

int message_at(struct message *message, const char *file, size_t line, size_t column, const char *format, ...)
{
  char text[sizeof message->text];
  int used = snprintf(text, sizeof text, "%s:%zu:%zu: ", file, line, column);
  if (used < 0 || (size_t)used >= sizeof text)
    return 0;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + used, sizeof text - (size_t)used, format, arguments);
  va_end(arguments);
  text_escape(text, message->text, sizeof message->text);
  message->kind = MESSAGE_WRONG;
  return 0;
}
