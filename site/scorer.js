/* Sphinx's own weights; and more for a recipe whose heading has the word, and for the first page of the repository. */
var Scorer = {
  score: ([docname, , , , score]) => score + (docname === 'docs/how-to' && score >= 15 ? 8 : docname === 'README' ? 4 : 0),
  objNameMatch: 11, objPartialMatch: 6, objPrio: {0: 15, 1: 5, 2: -5}, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
