#include "base/message.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/text.h"

/* Names and files of others are among the arguments, so all of the text is escaped. */
int message_set(struct message *message, const char *format, ...)
{
  char text[sizeof message->text];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  text_escape(text, message->text, sizeof message->text);
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
  return 0;
}
