// What the colors of the picture mean.
import {kinds, marked, theme} from './palette.js';

/** @returns a function (values, info, view, looks) that writes the legend; its `scale(fastest)` writes that of the flow's arrows. */
export function begin_legend(list, scale) {
  const entry = (color, text) => {
    const item = document.createElement('li'), swatch = document.createElement('i');
    swatch.style.background = color;
    item.append(swatch, text);
    return item;
  };
  const legend = (values, info, view, looks) => {
    if (!info) return;
    const colors = kinds[theme()], several = values.fibers?.length > 1;
    list.replaceChildren(...(values.fibers ?? []).map((kind, at) => entry(colors[at % colors.length],
      `${kind.count} ${kind.ring ? 'rings' : kind.vertices > 1 ? 'fibers' : 'points'}${several ? ` “${kind.name}”` : ''} of ${kind.vertices} vertices${kind.diameter ? `, ${kind.diameter} a₀ thick` : ''}`)));
    if (info.fibers) list.append(entry(marked[theme()], looks.trace ? 'the marked one, and where it has been' : 'the marked one'));
    if (info.particles) list.append(entry('transparent', `${info.particles.toLocaleString('en')} solvent particles${looks.solvent === 'none' ? ', not drawn' : ''}`));
  };
  legend.scale = fastest => {
    scale.hidden = !(fastest > 0);
    if (fastest > 0) scale.textContent = `longest arrow: ${fastest.toPrecision(2)} a₀/t₀`;
  };
  return legend;
}
