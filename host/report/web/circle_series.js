// The charts of the circle that run over time and over feed: the lap, and the peaks. Each function draws one from the
// state.
'use strict';

// Error and current (or voltage) of each axis, in the order of the charts from top to bottom.
const CHANNELS = ['error', 'current'].flatMap(kind => DATA.axes.map((axis, i) => ({
  kind, axis, index: i, name: kind === 'error' ? kind : DATA.efforts[i].name, unit: kind === 'error' ? 'µm' : DATA.efforts[i].unit,
  peak: 'peak_' + kind })));

// ---- lap ----

const LAP_GAP = 0.045;  // between two charts, of the height of all

// Instants at which the angle passes that of a reversal, and the axis that reverses there.
function reversals(run) {
  const found = [];
  for (let i = 1; i < run.angle.length; ++i) {
    const [low, high] = [run.angle[i - 1], run.angle[i]].sort((a, b) => a - b);
    const crossed = REVERSALS[1] * Math.ceil(low / REVERSALS[1]);
    if (crossed >= high) continue;
    const share = (crossed - run.angle[i - 1]) / (run.angle[i] - run.angle[i - 1]);
    const angle = (crossed % 360 + 360) % 360;
    found.push({ time: run.time[i - 1] + share * (run.time[i] - run.time[i - 1]), angle, axis: DATA.axes[reversingAxis(angle)] });
  }
  return found;
}

function drawLap(state) {
  const runs = chosenRuns(state);
  const traces = [], layout = { margin: { l: 58, r: 14, t: 24, b: 46 }, shapes: [], annotations: [] };
  CHANNELS.forEach((channel, row) => {
    const n = row ? row + 1 : '';
    for (const run of runs)
      traces.push({ name: traceName(run), x: run.time, y: run.axes[channel.index][channel.kind], mode: 'lines', line: lineOf(run, 1.4),
                    xaxis: 'x', yaxis: 'y' + n, hovertemplate: `${traceName(run)}<br>${channel.axis} %{y:.2f} ${channel.unit} at %{x:.3f} s<extra></extra>` });
    const height = (1 - (CHANNELS.length - 1) * LAP_GAP) / CHANNELS.length, bottom = 1 - row * LAP_GAP - (row + 1) * height;
    layout['yaxis' + n] = axisStyle(`${channel.axis} ${channel.name}, ${channel.unit}`,
      { domain: [Math.max(0, bottom), bottom + height], anchor: 'x', zeroline: true, zerolinecolor: RULE, nticks: 5 });
  });
  layout.xaxis = axisStyle('time in the lap, s', { anchor: 'y' + CHANNELS.length, range: runs.length ? [0, Math.max(...runs.map(run => run.time.at(-1)))] : undefined });
  // Opposite directions pass the same reversal at other instants, so both together have marks without words.
  for (const { time, angle, axis } of runs.length ? reversals(runs[0]) : []) {
    layout.shapes.push({ type: 'line', x0: time, x1: time, yref: 'paper', y0: 0, y1: 1, layer: 'below', line: { color: RULE, width: 1, dash: 'dot' } });
    if (state.direction !== 'both') layout.annotations.push(label(`${axis} reverses, ${angle}°`, time, 1, { yref: 'paper', yanchor: 'bottom', font: { size: 11.5, color: QUIET } }));
  }
  return drawChart('lap', traces, layout);
}

// ---- peaks against feed ----

function peakTraces(state, channel, axes) {
  const traces = [];
  for (const model of DATA.models) {
    if (state.hidden.has(model.name)) continue;
    const { colour, symbol } = modelStyles[model.name];
    for (const direction of DATA.directions.filter(each => directionChosen(state, each))) {
      const runs = DATA.runs.filter(run => run.friction === model.name && run.direction === direction).sort((a, b) => a.feed - b.feed);
      if (!runs.length) continue;
      const name = traceName(runs[0]);
      traces.push({ ...axes, name, x: runs.map(run => run.feed), y: runs.map(run => run.axes[channel.index][channel.peak]), mode: 'lines+markers',
                    line: lineOf(runs[0]), marker: { symbol, size: 6, color: colour },
                    hovertemplate: `${name}<br>${channel.axis} %{y:.2f} ${channel.unit} at %{x} m/min<extra></extra>` });
    }
    const published = DATA.references.filter(row => !row.measured && row.axis === channel.axis && row.friction === model.name);
    const name = `${model.label}, published`;
    if (published.length)
      traces.push({ ...axes, name, x: published.map(row => row.feed), y: published.map(row => row[channel.kind]), mode: 'markers',
                    marker: { symbol: symbol + '-open', size: 11, color: colour, line: { width: 1.3 } }, cliponaxis: false,
                    hovertemplate: `${name}<br>${channel.axis} %{y} ${channel.unit} at %{x} m/min<extra></extra>` });
  }
  const measured = DATA.references.filter(row => row.measured && row.axis === channel.axis);
  if (measured.length)
    traces.push({ ...axes, name: 'measured', x: measured.map(row => row.feed), y: measured.map(row => row[channel.kind]), mode: 'markers',
                  marker: MEASURED, cliponaxis: false, hovertemplate: `measured<br>${channel.axis} %{y} ${channel.unit} at %{x} m/min<extra></extra>` });
  return traces;
}

// Error left, current right, one row an axis; on a narrow page one below the other.
function peakDomains(i, narrow) {
  if (narrow) {
    const height = 1 / CHANNELS.length, top = 1 - i * height;
    return { x: [0, 1], y: [top - height + (i + 1 < CHANNELS.length ? 0.07 : 0), top] };
  }
  const rows = CHANNELS.length > 2 ? 2 : 1;
  return { x: i % 2 ? [0.545, 1] : [0, 0.455], y: rows === 1 ? [0, 1] : i < 2 ? [0.575, 1] : [0, 0.425] };
}

function peakLayout(state, narrow) {
  const layout = { margin: { l: 58, r: 14, t: 10, b: 46 }, shapes: [], annotations: [] };
  const feeds = [...new Set([...DATA.feeds, ...DATA.references.map(row => row.feed)])];
  const range = [0, 1.06 * Math.max(...feeds)];
  CHANNELS.forEach((channel, i) => {
    const n = i ? i + 1 : '', domain = peakDomains(i, narrow);
    layout['xaxis' + n] = axisStyle('feed, m/min', { domain: domain.x, anchor: 'y' + n, range, ...(feeds.length <= 8 && !narrow ? { tickvals: feeds } : {}) });
    layout['yaxis' + n] = axisStyle(`${channel.axis} peak ${channel.name}, ${channel.unit}`, { domain: domain.y, anchor: 'x' + n, rangemode: 'tozero' });
    layout.shapes.push({ type: 'line', xref: 'x' + n, yref: `y${n} domain`, x0: state.feed, x1: state.feed, y0: 0, y1: 1, layer: 'below',
                         line: { color: 'var(--stripe)', width: 9 } });
  });
  return layout;
}

function drawPeaks(state) {
  const traces = CHANNELS.flatMap((channel, i) => peakTraces(state, channel, { xaxis: 'x' + (i ? i + 1 : ''), yaxis: 'y' + (i ? i + 1 : '') }));
  return drawChart('peaks', traces, narrow => peakLayout(state, narrow));
}
