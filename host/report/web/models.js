// The colours of friction models, and of anything else that is drawn.
'use strict';

// One colour and one symbol a friction model, whatever else is shown; they stay apart for colour-blind eyes.
const MODEL_STYLES = {
  coulomb_viscous: { colour: '#8b9098', symbol: 'x' },
  classical: { colour: '#c2500f', symbol: 'square' },
  linear_ramp: { colour: '#dd9f00', symbol: 'triangle-up' },
  parabolic: { colour: '#0f9b78', symbol: 'triangle-down' },
  lugre: { colour: '#0b5fa5', symbol: 'circle' },
  maxwell_slip: { colour: '#a3509b', symbol: 'star' },
};
const OTHER_STYLES = [{ colour: '#3f4a56', symbol: 'hexagon' }, { colour: '#56a8d8', symbol: 'cross' }, { colour: '#d4577f', symbol: 'pentagon' },
                      { colour: '#7d8f2b', symbol: 'hourglass' }];
const MEASURED = { color: '#000', symbol: 'diamond', size: 10 };

// The styles of all models, and of each other name the next one that no model on the page has.
function stylesOf(names) {
  const others = [...new Set(names)].filter(name => !Object.hasOwn(MODEL_STYLES, name));
  const unused = Object.entries(MODEL_STYLES).filter(([name]) => !names.includes(name)).map(([, style]) => style);
  const free = [...OTHER_STYLES, ...unused];
  return { ...MODEL_STYLES, ...Object.fromEntries(others.map((name, i) => [name, free[i % free.length]])) };
}

function swatch({ colour, dash }) {
  const line = dash ? `repeating-linear-gradient(90deg, ${colour} 0 4px, transparent 4px 7px)` : colour;
  return element('span', { class: 'swatch', style: `background:${line}` });
}
