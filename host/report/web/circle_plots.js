// The charts of the circle: polar plot, quadrant, lap, peaks against feed. Each function draws one from the state.
'use strict';

// Two axes drive a circle, one alone a sine: that axis' part of it.
const IS_CIRCLE = DATA.axes.length === 2;
const REVERSALS = IS_CIRCLE ? [0, 90, 180, 270] : [0, 180];  // degrees of the path

const DIRECTION_TEXT = { ccw: 'counter-clockwise', cw: 'clockwise', both: 'both directions' };
const DIRECTION_SIGN = { ccw: '↺ ', cw: '↻ ', both: '' };
const CLOCKWISE_DASH = '1.5px 3px';  // of the second direction, where both are on the page

const modelLabels = Object.fromEntries(DATA.models.map(model => [model.name, model.label]));
const modelStyles = stylesOf(DATA.models.map(model => model.name));

// Angles without a jump from 180 to -180 degrees.
function unwrapped(angles) {
  const turned = Array.from(angles);
  for (let i = 1; i < turned.length; ++i) turned[i] -= 360 * Math.round((turned[i] - turned[i - 1]) / 360);
  return turned;
}

for (const run of DATA.runs) {
  for (const name of ['time', 'angle', ...(IS_CIRCLE ? ['radial'] : [])]) run[name] = decodeFloats(run[name]);
  run.angle = unwrapped(run.angle);
  for (const axis of run.axes)
    for (const name of ['error', 'current']) axis[name] = decodeFloats(axis[name]);
}

// ---- what is chosen ----

function directionChosen(state, direction) {
  return state.direction === 'both' || state.direction === direction;
}

function chosenRuns(state) {
  return DATA.runs.filter(run => run.feed === state.feed && directionChosen(state, run.direction) && !state.hidden.has(run.friction));
}

function chosenText(state) {
  return `at ${state.feed} m/min` + (IS_CIRCLE ? `, ${DIRECTION_TEXT[state.direction]}` : '');
}

function traceName(run) {
  return modelLabels[run.friction] + (run.direction === 'cw' && DATA.directions.length > 1 ? ', clockwise' : '');
}

function lineOf(run, width = 1.6) {
  const { colour, dash } = modelStyles[run.friction];
  return { color: colour, width, dash: run.direction === 'cw' && DATA.directions.length > 1 ? CLOCKWISE_DASH : dash };
}

function reference(axis, feed, friction = null) {
  return DATA.references.find(row => row.axis === axis && Math.abs(row.feed - feed) <= 1e-4 * feed &&
                                     (friction === null ? row.measured : !row.measured && row.friction === friction));
}

// ---- polar plot ----

const MAGNIFICATIONS = [100, 200, 500, 1000, 2000, 5000];

// The circle would fold through its centre where R + M ΔR falls to zero.
function magnificationFits(magnification, runs) {
  return runs.every(run => run.radial.every(deviation => run.radius + magnification * deviation * 1e-3 > 0.05 * run.radius));
}

function polarTrace(run, magnification) {
  const x = [], y = [], text = [];
  for (let i = 0; i <= run.angle.length; ++i) {
    const k = i % run.angle.length;  // closes the lap
    const angle = run.angle[k] * Math.PI / 180;
    const radius = run.radius + magnification * run.radial[k] * 1e-3;
    x.push(radius * Math.cos(angle));
    y.push(radius * Math.sin(angle));
    text.push(`${formatNumber(run.radial[k], 2)} µm at ${formatNumber((run.angle[k] % 360 + 360) % 360, 1)}°`);
  }
  const name = traceName(run);
  return { name, x, y, text, mode: 'lines', line: lineOf(run), hovertemplate: `${name}<br>ΔR %{text}<extra></extra>` };
}

function circleShape(radius, line) {
  return { type: 'circle', x0: -radius, x1: radius, y0: -radius, y1: radius, line, layer: 'below' };
}

function sectorShape(centre, half, inner, outer) {
  const points = [];
  for (let i = 0; i <= 24; ++i) points.push([outer, centre - half + i * half / 12]);
  for (let i = 24; i >= 0; --i) points.push([inner, centre - half + i * half / 12]);
  const path = points.map(([r, a]) => `${r * Math.cos(a * Math.PI / 180)},${r * Math.sin(a * Math.PI / 180)}`);
  return { type: 'path', path: `M${path.join('L')}Z`, fillcolor: 'var(--sector)', line: { width: 0 }, layer: 'below' };
}

const extreme = (values, pick) => values.reduce((most, value) => pick(most, value));

// Rings a division apart around the circle, as many as the deviations need; what lies in the middle says the scale.
function polarGrid(state, runs, radius, division, narrow) {
  const step = division * state.magnification * 1e-3;  // mm drawn
  const high = Math.max(2, ...runs.map(run => Math.ceil(extreme(run.radial, Math.max) / division)));
  const low = Math.min(-2, ...runs.map(run => Math.floor(extreme(run.radial, Math.min) / division)));
  const shapes = [], annotations = [];
  for (let ring = low; ring <= high; ++ring) {
    if (radius + ring * step <= 0) continue;
    shapes.push(circleShape(radius + ring * step, ring ? { color: GRID, width: 1 } : { color: RULE, width: 1 }));
    if (ring && (narrow ? ring % 2 === 0 : Math.abs(ring) < 3 || ring % 2 === 0))
      annotations.push(label(`${ring > 0 ? '+' : '−'}${Math.abs(ring) * division}`, (radius + ring * step) * Math.SQRT1_2,
                             (radius + ring * step) * Math.SQRT1_2, { font: { size: 10.5, color: QUIET }, bgcolor: 'var(--veil)', borderpad: 0 }));
  }
  const inner = Math.max(0, radius + low * step), outer = radius + high * step;
  for (let angle = 0; angle < 360; angle += 30) {
    const c = Math.cos(angle * Math.PI / 180), s = Math.sin(angle * Math.PI / 180);
    shapes.push({ type: 'line', x0: inner * c, y0: inner * s, x1: outer * c, y1: outer * s, layer: 'below',
                  line: { color: angle % 90 ? GRID : 'var(--line)', width: 1 } });
    if (angle % 90 === 0) annotations.push(label(`${angle}°`, (outer + 0.07 * radius) * c, (outer + 0.07 * radius) * s));
  }
  return { shapes, annotations, inner, outer, step };
}

// On a narrow page the words in the middle need more of the circle.
function scaleBar(state, division, step, radius, narrow) {
  const line = { color: INK, width: 1.5 }, y = -0.02 * radius, tick = 0.018 * radius, apart = narrow ? 1.9 : 1, size = narrow ? 10 : 12;
  const bar = (x0, y0, x1, y1) => ({ type: 'line', x0, y0, x1, y1, line });
  const words = (content, height, font) => label(content, 0, apart * height * radius, { font: { size, color: QUIET, ...font } });
  return { shapes: [bar(-step / 2, y, step / 2, y), bar(-step / 2, y - tick, -step / 2, y + tick), bar(step / 2, y - tick, step / 2, y + tick)],
           annotations: [words(`<b>${state.feed} m/min</b>`, 0.25, { size: narrow ? 12 : 15, color: INK }),
                         words(DIRECTION_SIGN[state.direction] + DIRECTION_TEXT[state.direction], 0.15),
                         words(`${division} µm per division`, -0.10, { color: INK }),
                         words(narrow ? `magnified ${state.magnification} ×` : `deviation magnified ${state.magnification} ×`, -0.19)] };
}

function polarLayout(state, runs, narrow) {
  const radius = (runs[0] || DATA.runs[0]).radius;
  const division = roundUpNice(radius / 9 / state.magnification * 1e3);  // µm
  const grid = polarGrid(state, runs, radius, division, narrow);
  const bar = scaleBar(state, division, grid.step, radius, narrow);
  const sector = sectorShape(state.quadrant, quadrantHalfWidth(state), grid.inner, grid.outer);
  const limit = grid.outer + 0.2 * radius;
  const ticks = [-radius, -radius / 2, 0, radius / 2, radius];
  const style = { range: [-limit, limit], showgrid: false, tickvals: ticks, constrain: 'domain' };
  return { margin: { l: 52, r: 8, t: 8, b: 46 },
           xaxis: axisStyle(`${DATA.axes[0]}, mm`, style),
           yaxis: axisStyle(`${DATA.axes[1]}, mm`, { ...style, scaleanchor: 'x' }),
           shapes: [sector, ...grid.shapes, ...bar.shapes], annotations: [...grid.annotations, ...bar.annotations] };
}

function drawPolar(state) {
  const runs = chosenRuns(state);
  return drawChart('polar', runs.map(run => polarTrace(run, state.magnification)), narrow => polarLayout(state, runs, narrow));
}

// ---- quadrant ----

const WINDOWS = [5, 15, 45];

// The first axis, or the only one, reverses at 0 and 180 degrees, the second at 90 and 270.
function reversingAxis(quadrant) {
  return quadrant % 180 ? 1 : 0;
}

// Points of one axis within the window, by rising angle from the reversal.
function around(run, quadrant, half) {
  const error = run.axes[reversingAxis(quadrant)].error;
  const points = [];
  run.angle.forEach((angle, i) => {
    const from = ((angle - quadrant + 180) % 360 + 360) % 360 - 180;
    if (Math.abs(from) <= half) points.push([quadrant + from, error[i]]);
  });
  return points.sort((a, b) => a[0] - b[0]);
}

// As wide as the glitches need: where an error stands out from its run's median by a sixth of its own peak, and a little
// more. A run without a glitch to speak of, below a tenth of the largest, has no say.
function quadrantHalfWidth(state) {
  if (state.window !== 'auto') return state.window;
  const outstanding = chosenRuns(state).map(run => {
    const points = around(run, state.quadrant, 45);
    const median = points.map(point => point[1]).sort((a, b) => a - b)[points.length >> 1];
    const heights = points.map(([angle, error]) => [Math.abs(angle - state.quadrant), Math.abs(error - median)]);
    return { heights, peak: extreme(heights.map(point => point[1]), Math.max) };
  });
  const highest = outstanding.reduce((most, run) => Math.max(most, run.peak), 0);
  let reach = 0;
  for (const { heights, peak } of outstanding.filter(run => run.peak > 0.1 * highest))
    for (const [angle, height] of heights)
      if (height > peak / 6) reach = Math.max(reach, angle);
  return [2, 3, 5, 8, 10, 15, 20, 30].find(half => half >= 1.25 * reach) || 45;
}

function measuredTrace(axis, measured, half, quadrant, peaks) {
  const level = (peaks >= 0 ? 1 : -1) * measured.error;
  return { name: 'measured', x: [quadrant - half, quadrant + half], y: [level, level], mode: 'lines+markers', cliponaxis: false,
           line: { color: INK, width: 1, dash: '2px 3px' }, marker: MEASURED,
           hovertemplate: `${axis} measured, peak ${formatNumber(measured.error, 1)} µm<extra></extra>` };
}

function drawQuadrant(state) {
  const half = quadrantHalfWidth(state), quadrant = state.quadrant;
  const axis = DATA.axes[reversingAxis(quadrant)];
  let peaks = 0;  // the sign in which the measured peak is drawn: that of the simulated ones
  const traces = chosenRuns(state).map(run => {
    const points = around(run, quadrant, half + 4), name = traceName(run);  // lines run on through the edges
    peaks += points.reduce((most, [, error]) => Math.abs(error) > Math.abs(most) ? error : most, 0);
    return { name, x: points.map(p => p[0]), y: points.map(p => p[1]), mode: 'lines', line: lineOf(run, 1.8),
             hovertemplate: `${name}<br>%{y:.2f} µm at %{x:.1f}°<extra></extra>` };
  });
  const annotations = [label(`${axis} reverses`, quadrant, 1, { yref: 'paper', yanchor: 'bottom', font: { size: 12, color: QUIET } })];
  const measured = reference(axis, state.feed);
  if (measured) {
    traces.push(measuredTrace(axis, measured, half, quadrant, peaks));
    annotations.push(label(`measured peak ${formatNumber(measured.error, 1)} µm`, quadrant - half, traces.at(-1).y[0],
                           { xanchor: 'left', yanchor: peaks >= 0 ? 'bottom' : 'top', xshift: 8, font: { size: 12, color: INK } }));
  }
  return drawChart('quadrant', traces, {
    margin: { l: 58, r: 14, t: 24, b: 46 },
    xaxis: axisStyle(IS_CIRCLE ? 'angle from +' + DATA.axes[0] + ', degrees' : 'phase of the sine, degrees', { range: [quadrant - half, quadrant + half], ticksuffix: '°' }),
    yaxis: axisStyle(`${axis} error at the encoder, µm`, { zeroline: true, zerolinecolor: RULE, nticks: 7 }),
    shapes: [{ type: 'line', x0: quadrant, x1: quadrant, yref: 'paper', y0: 0, y1: 1, line: { color: RULE, width: 1, dash: 'dot' }, layer: 'below' }],
    annotations,
  });
}
