/* Contacts of bonds with the bead in the steps of a run, for the operators `bead_search`, `bead_contact` and `impulse`
 * of fibers around a bead. */
#ifndef UNCROSS_ORACLE_COMPANY_H
#define UNCROSS_ORACLE_COMPANY_H

#include "oracle/rows.h"

enum { ORACLE_COMPANY_MOST = 150 }; /* contacts: the first ones of the run */

struct oracle_company {
  const struct oracle_stage *stage;
  uint32_t contacts;
  struct oracle_search
      search[3 * ORACLE_COMPANY_MOST]; /* of each: that which found it, one from midway, that after it */
  struct oracle_tubes tubes[ORACLE_COMPANY_MOST];
  struct oracle_impulse impulse[ORACLE_COMPANY_MOST]; /* ends of the bond; the bead; nobody, of mass 1, with t = 0 */
};

/* A contact_log's record: takes contacts with the bead, and leaves the others. context: struct oracle_company. */
void oracle_company_take(void *context, const struct contact_event *event);

#endif
