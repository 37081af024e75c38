/*
 * What contacts of thick fibers hand on. An impulse J passes along the normal n from one bond to another, over the gap
 * g between their points of contact. So the four vertices k, which share it by their levers, add to the virial
 *
 *   sum of r_a,k dP_b,k = J g n_a n_b
 *
 * and in a time t to the pressure tensor (1/V t) times the sum over all contacts: the tubes of two fibers have g = (D_1
 * + D_2)/2 there, and thin lines 0. In a periodic box the image of the other bond counts that is touched. Thick
 * fibers are refused between walls and in sheared boxes (system/refusals_list.h). A bead or a held vertex takes
 * momentum out of the sum, so meaning.c refuses or leaves out the columns that such contacts would enter.
 */
#ifndef UNCROSS_OBSERVE_HANDED_ON_H
#define UNCROSS_OBSERVE_HANDED_ON_H

#include "contact/contact.h"
#include "observe/observer.h"
#include "system/fluid.h"

/* These are members of struct observer_type, or parts of them. */

/* Adds the memory: in `later`, and none without thick fibers. */
void handed_on_size(const struct observer *observer, const struct model *model, struct observer_size *size);

/* Adds a contact. */
void handed_on_add(struct observer *observer, const struct contact_event *event);

/* Sum of J g n_a n_b over the time since this was called before, over this time; kT. 0 without thick fibers; NaN in the
 * first row of a run that an earlier program began. False, and nothing begins anew, if no time has passed. */
bool handed_on_mean(struct observer *observer, const struct view *view, double mean[STRESS_COMPONENTS]);

#endif
