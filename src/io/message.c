#include "io/message.h"

#include <stdarg.h>
#include <stdio.h>

int message_set(struct message *message, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message->text, sizeof message->text, format, arguments);
  va_end(arguments);
  return 0;
}

int message_at(struct message *message, const char *file, size_t line, size_t column, const char *format, ...)
{
  int used = snprintf(message->text, sizeof message->text, "%s:%zu:%zu: ", file, line, column);
  if (used < 0 || (size_t)used >= sizeof message->text)
    return 0;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message->text + used, sizeof message->text - (size_t)used, format, arguments);
  va_end(arguments);
  return 0;
}

int message_fault(struct message *message, const struct fault *fault)
{
  fault_describe(fault, message->text, sizeof message->text);
  return 0;
}
