// Colors of Okabe and Ito (Color Universal Design, 2008), in an order in which neighbors differ in lightness too.
export const kinds = {
  light: ['#0072B2', '#E69F00', '#009E73', '#CC79A7', '#56B4E9'],
  dark: ['#56B4E9', '#E69F00', '#009E73', '#CC79A7', '#0072B2'],
};
export const marked = {light: '#D55E00', dark: '#FF7A33'};

/** The theme that holds now. @returns {'light'|'dark'} */
export const theme = () => document.documentElement.dataset.theme === 'dark' ? 'dark' : 'light';

/** Value of a custom property of the style sheet, e.g. `--ink`. */
export const paint = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** [r, g, b] in 0 .. 1 of a color `#rrggbb`, not linearized. */
export const rgb = hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16) / 255);

/** Follows the system's theme until the button says otherwise, and keeps what it said. */
export function begin_theme(button, changed) {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const kept = () => { try { return localStorage.getItem('theme'); } catch { return null; } };
  const show = () => {
    const dark = (kept() ?? (system.matches ? 'dark' : 'light')) === 'dark';
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
    button.setAttribute('aria-pressed', String(dark));
    button.textContent = dark ? 'Light' : 'Dark';
    button.setAttribute('aria-label', dark ? 'Light colors' : 'Dark colors');
    button.removeAttribute('aria-pressed');
    changed();
  };
  system.addEventListener('change', show);
  button.addEventListener('click', () => {
    try { localStorage.setItem('theme', theme() === 'dark' ? 'light' : 'dark'); } catch { /* private windows keep nothing */ }
    show();
  });
  show();
}
