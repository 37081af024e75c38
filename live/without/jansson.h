/* In place of jansson's own: what files/record.h names. */
#ifndef UNCROSS_LIVE_JANSSON_H
#define UNCROSS_LIVE_JANSSON_H

typedef struct json_t json_t;

#endif
