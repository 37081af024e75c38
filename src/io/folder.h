/* Folders that runs write into. */
#ifndef UNCROSS_FOLDER_H
#define UNCROSS_FOLDER_H

#include <stdbool.h>

#include "io/message.h"

/* Makes the folder and those above it, if they are not there, and checks that it may be written into. */
bool folder_make(const char *folder, struct message *message);

/* True if the folder holds a file of this name. */
bool folder_has(const char *folder, const char *name);

#endif
