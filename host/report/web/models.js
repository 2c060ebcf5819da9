// Which colour, symbol and dash each friction model has, and anything else that is drawn. The colours themselves are in
// colours.css.
'use strict';

// One style a friction model, whatever else is shown. The dash is drawn where more series are shown than colours alone
// keep apart.
const MODEL_STYLES = {
  lugre: { colour: 'var(--blue)', symbol: 'circle' },
  classical: { colour: 'var(--orange)', symbol: 'square' },
  parabolic: { colour: 'var(--teal)', symbol: 'triangle-down' },
  coulomb_viscous: { colour: 'var(--grey)', symbol: 'x', dash: '9px 3px' },
  maxwell_slip: { colour: 'var(--purple)', symbol: 'star', dash: '5px 2px' },
  linear_ramp: { colour: 'var(--ochre)', symbol: 'triangle-up', dash: '9px 3px 2px 3px' },
  dahl: { colour: 'var(--sky)', symbol: 'pentagon', dash: '5px 2px' },
  elasto_plastic: { colour: 'var(--brown)', symbol: 'hexagon', dash: '9px 3px 2px 3px' },
  curve: { colour: 'var(--pink)', symbol: 'cross', dash: '11px 2px 2px 2px 2px 2px' },
};
const OTHER_STYLES = [{ colour: 'var(--slate)', symbol: 'hexagon' }, { colour: 'var(--indigo)', symbol: 'cross', dash: '5px 2px' },
                      { colour: 'var(--pink)', symbol: 'pentagon', dash: '9px 3px' }, { colour: 'var(--olive)', symbol: 'hourglass', dash: '9px 3px 2px 3px' }];
const MEASURED = { color: 'var(--ink)', symbol: 'diamond', size: 10 };
const FEW = 3;  // series that their colours alone keep apart

// The styles of all models, and of each other name the next one that no model on the page has. `names`: of all series
// that may be shown together; up to FEW of them are drawn without dashes.
function stylesOf(names) {
  const distinct = [...new Set(names)], others = distinct.filter(name => !Object.hasOwn(MODEL_STYLES, name));
  const unused = Object.entries(MODEL_STYLES).filter(([name]) => !names.includes(name)).map(([, style]) => style);
  const taken = new Set(distinct.filter(name => MODEL_STYLES[name]).map(name => MODEL_STYLES[name].colour));
  const free = [...OTHER_STYLES, ...unused].filter(style => !taken.has(style.colour));
  const styles = { ...MODEL_STYLES, ...Object.fromEntries(others.map((name, i) => [name, free[i % free.length]])) };
  if (distinct.length > FEW) return styles;
  return Object.fromEntries(Object.entries(styles).map(([name, { dash, ...style }]) => [name, style]));
}

// A dash as the two lengths that a gradient needs, "9px 3px" as 9 and 3.
function swatch({ colour, dash }) {
  if (!dash) return element('span', { class: 'swatch', style: `background:${colour}` });
  let at = 0;
  const parts = dash.split(' ').map((length, i) => `${i % 2 ? 'transparent' : colour} ${at}px ${at += parseFloat(length)}px`);
  return element('span', { class: 'swatch', style: `background:repeating-linear-gradient(90deg, ${parts.join(', ')})` });
}
