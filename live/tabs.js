// Tabs as the W3C's ARIA patterns describe them: arrows move and choose.
export function begin_tabs(list) {
  const tabs = () => [...list.querySelectorAll('[role="tab"]:not([hidden])')];
  const choose = (tab, focus) => {
    for (const one of list.querySelectorAll('[role="tab"]')) {
      const chosen = one === tab;
      one.setAttribute('aria-selected', String(chosen));
      one.tabIndex = chosen ? 0 : -1;
      document.getElementById(one.getAttribute('aria-controls')).hidden = !chosen;
    }
    if (focus) tab.focus();
  };
  list.addEventListener('click', event => { const tab = event.target.closest('[role="tab"]'); if (tab) choose(tab); });
  list.addEventListener('keydown', event => {
    const all = tabs(), at = all.indexOf(document.activeElement);
    const to = {ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: all.length - 1}[event.key];
    if (to === undefined || at < 0) return;
    choose(all[(to + all.length) % all.length], true);
    event.preventDefault();
  });
}
