/* Contacts of bonds with the bead in the steps of a run, for the operators `bead_search`, `bead_contact` and `impulse`
 * of fibers around a bead. */
#ifndef UNCROSS_ORACLE_COMPANY_H
#define UNCROSS_ORACLE_COMPANY_H

#include "contact/contact.h"
#include "oracle/event_rows.h"
#include "oracle/tube_rows.h"

enum { ORACLE_COMPANY_MOST = 150 }; /* contacts: the first ones of the run */

struct oracle_company {
  const struct oracle_stage *stage;
  struct oracle_search *search;   /* [3 contacts] the one that found it, one that begins midway, the one after it */
  struct oracle_tubes *tubes;     /* [contacts] */
  struct oracle_impulse *impulse; /* [contacts] ends of the bond; the bead; nobody, of mass 1, with t = 0 */
  uint32_t contacts, room;
  bool failed; /* memory was short */
};

/* A contact_log's record: takes contacts with the bead, and leaves the others. context: struct oracle_company. */
void oracle_company_take(void *context, const struct contact_event *event);

void oracle_company_free(struct oracle_company *company);

#endif
