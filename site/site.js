/* What scrolls in a box of its own is reached by the keyboard, too. */
addEventListener('load', () => {
  for (const box of document.querySelectorAll('pre, .table-wrapper, .formula'))
    if (box.scrollWidth > box.clientWidth)
      box.tabIndex = 0;
});
