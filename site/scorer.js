/* Sphinx's own weights, and more for the pages that answer most questions. */
const FIRST = {'docs/how-to': 8, 'README': 4};
var Scorer = {
  score: ([docname, , , , score]) => score + (FIRST[docname] ?? 0),
  objNameMatch: 11, objPartialMatch: 6, objPrio: {0: 15, 1: 5, 2: -5}, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
