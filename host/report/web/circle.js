// The circle's page: what is chosen, the controls that choose it, and what is drawn anew when it changes.
'use strict';

const state = {
  feed: DATA.selected_feed,
  direction: DATA.directions[0],
  hidden: new Set(),  // names of friction models
  magnification: 1000,
  quadrant: 0,
  window: 'auto',  // or half its width in degrees
};

// ---- controls ----

function drawControls() {
  segments('choose-feed', DATA.feeds.map(feed => ({ value: feed, label: String(feed) })), state.feed, value => change({ feed: value }));
  segments('choose-quadrant', REVERSALS.map(angle => ({ value: angle, label: `${angle}° ${DATA.axes[reversingAxis(angle)]}` })), state.quadrant,
           value => change({ quadrant: value }));
  segments('choose-window', [{ value: 'auto', label: 'auto' }, ...WINDOWS.map(half => ({ value: half, label: `${half}°` }))], state.window,
           value => change({ window: value }));
  if (!IS_CIRCLE) return;
  const directions = DATA.directions.length > 1 ? [...DATA.directions, 'both'] : DATA.directions;
  segments('choose-direction', directions.map(direction => ({ value: direction, label: DIRECTION_TEXT[direction] })), state.direction,
           value => change({ direction: value }));
  drawMagnifications();
}

function drawMagnifications() {
  const runs = chosenRuns(state);
  const options = MAGNIFICATIONS.map(value => ({ value, label: String(value), disabled: !magnificationFits(value, runs) }));
  for (const option of options)
    if (option.disabled) option.title = 'the drawn deviation would reach beyond the centre';
  segments('choose-magnification', options, state.magnification, value => change({ magnification: value }));
}

function drawModelChoice() {
  toggles('choose-models', DATA.models.map(model => ({ name: model.name, label: model.label, swatch: swatch(modelStyles[model.name]) })), state.hidden,
          () => change({}));
}

function drawKey() {
  const mark = (svg, text) => {
    const node = element('span');
    node.innerHTML = svg;  // the fixed drawings below
    node.append(text);
    return node;
  };
  const items = [mark('<svg viewBox="0 0 30 12"><path d="M0 6H30" stroke="currentColor" stroke-width="1.6"/><circle cx="15" cy="6" r="3" fill="currentColor"/></svg>', 'simulated')];
  if (DATA.directions.length > 1)
    items.push(mark('<svg viewBox="0 0 30 12"><path d="M0 6H30" stroke="currentColor" stroke-width="1.6" stroke-dasharray="5 3"/></svg>', 'clockwise'));
  if (DATA.references.some(row => !row.measured))
    items.push(mark('<svg viewBox="0 0 30 12"><circle cx="15" cy="6" r="5" fill="none" stroke="currentColor" stroke-width="1.3"/></svg>', 'published simulation'));
  if (DATA.references.some(row => row.measured))
    items.push(mark('<svg viewBox="0 0 30 12"><path d="M15 0L21 6L15 12L9 6Z" class="ink"/></svg>', 'measured'));
  show('feed-key', ...items);
}

// ---- what depends on them ----

function largestFitting(magnification) {
  const runs = chosenRuns(state);
  return MAGNIFICATIONS.filter(each => each <= magnification && magnificationFits(each, runs)).at(-1) || MAGNIFICATIONS[0];
}

function drawChosen() {
  if (IS_CIRCLE) drawPolar(state);
  drawQuadrant(state);
  drawLap(state);
  drawPeaks(state);
  drawFigures(state);
  document.getElementById('lap-what').textContent = chosenText(state);
}

function change(chosen) {
  Object.assign(state, chosen);
  if (IS_CIRCLE) state.magnification = largestFitting(state.magnification);
  drawControls();
  drawChosen();
}

drawConditions();
drawModelChoice();
drawKey();
drawComparison();
if (IS_CIRCLE) drawIso();
else {
  document.querySelectorAll('.of-circle, #direction-control').forEach(part => part.remove());
  document.querySelector('section.pair').classList.remove('pair');
  document.body.classList.add('one-axis');
}
drawMachine();
change({});
document.getElementById('peaks').on('plotly_click', event => {
  if (FIGURES.get('peaks').cursors) return;
  const feed = event.points[0].x;
  if (DATA.feeds.includes(feed)) change({ feed });
});
drawForPaper();
drawSchemeSwitch();
