/* What scrolls in a box of its own is reached by the keyboard, too, and fades at its edge while there is more. */
addEventListener('load', () => {
  const boxes = document.querySelectorAll('article :is(pre, .table-wrapper, .formula)');
  const look = box => {
    const more = box.scrollWidth - box.clientWidth;
    box.classList.toggle('goes-on', more > 1 && box.scrollLeft < more - 1);
    if (more > 1)
      box.tabIndex = 0;
  };
  for (const box of boxes) {
    look(box);
    box.addEventListener('scroll', () => look(box), {passive: true});
  }
  addEventListener('resize', () => boxes.forEach(look));
});
