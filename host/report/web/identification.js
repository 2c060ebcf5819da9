// The page of an identification: friction over speed, residuals, parameters, what the data could not determine.
'use strict';

const POSITIVE = 'var(--blue)', NEGATIVE = 'var(--orange)', CURVE = INK;
const minus = words => words.replace(/-(?=\d|x\b)/g, '−');  // of numbers and of the direction -x

// ---- tables ----

function parameterTable(rows, withHow) {
  const head = [text('Parameter', { class: 'text' }), text('Value'), text('95 % from'), text('to'), text('Unit', { class: 'text unit' })];
  if (withHow) head.push(text('How it was found', { class: 'text' }));
  const drawn = table([head], rows.map(row => {
    const cells = [{ text: symbolText(minus(row.label)), head: true, class: 'figure' }, text(minus(row.value), { class: 'value' }),
                   text(minus(row.low)), text(minus(row.high)), text(row.unit, { class: 'text unit' })];
    if (withHow) cells.push(text(minus(row.how), { class: 'text wrap source' }));
    return classed('first', cells);
  }));
  drawn.className = 'bare';
  return drawn;
}

function drawTables() {
  show('parameters', parameterTable(DATA.parameters, true));
  if (DATA.initial.length)
    show('initial', `Direct estimates from the record, as a check that is independent of the fit: ${
      DATA.initial.map(row => `${row.label}, ${minus(row.value)} ${row.unit}`).join('; ')}.`);
  if (!DATA.open.length) return document.getElementById('open-section').remove();
  const drawn = table([[text('Parameter', { class: 'text' }), text('Why', { class: 'text' }), text('Record instead', { class: 'text' })]],
    DATA.open.map(row => classed('first', [{ text: symbolText(row.label), head: true, class: 'figure' },
                                           text(minus(row.why), { class: 'text wrap' }), text(row.record, { class: 'text wrap' })])));
  drawn.className = 'bare';
  show('open', drawn);
}

// ---- estimates over the cut-off ----

function drawBand() {
  const band = DATA.band;
  if (!band || band.cutoff.length < 2) return document.getElementById('band-section').remove();
  const chosen = band.cutoff[band.chosen];
  const order = band.cutoff.map((_, k) => k).sort((one, other) => band.cutoff[one] - band.cutoff[other]);
  const looks = k => k === band.chosen ? ['circle', 10] : band.sound[k] ? ['circle-open', 7] : ['x-thin-open', 7];
  band.charts.forEach((chart, i) => {
    const marks = order.map(looks);
    const trace = { name: 'estimate', x: order.map(k => band.cutoff[k]), y: order.map(k => chart.value[k]), mode: 'markers', type: 'scatter',
                    error_y: { type: 'data', array: order.map(k => chart.half[k]), color: POSITIVE, thickness: 1.2, width: 3 },
                    marker: { color: POSITIVE, symbol: marks.map(mark => mark[0]), size: marks.map(mark => mark[1]), line: { width: 1.3, color: POSITIVE } },
                    hovertemplate: `%{y:.5~g} ${chart.unit} ± %{error_y.array:.2~g}<br>%{x:~g} Hz<extra></extra>` };
    // Cut-offs that cannot be chosen may be far off: the ordinate shows those that can, with room.
    const shown = band.cutoff.map((_, k) => k).filter(k => k === band.chosen || band.sound[k]);
    const low = Math.min(...shown.map(k => chart.value[k] - chart.half[k])), high = Math.max(...shown.map(k => chart.value[k] + chart.half[k]));
    const room = 0.15 * (high - low) || Math.abs(high) * 0.05 || 1;
    drawChart(`band-${i}`, [trace], {
      margin: { l: 76, r: 24, t: 10, b: 46 },
      shapes: [{ type: 'line', x0: chosen, x1: chosen, yref: 'paper', y0: 0, y1: 1, layer: 'below', line: { color: RULE, width: 1, dash: 'dot' } }],
      xaxis: axisStyle('cut-off, Hz', { type: 'log', tickformat: '~g', dtick: 'D2' }),
      yaxis: axisStyle(plain(`${chart.label}, ${chart.unit}`), { range: [low - room, high + room], nticks: 6 }),
    });
  });
  const refused = band.sound.filter(sound => !sound).length;
  show('band-caption', `Estimates with the 95 % intervals that the scatter between blocks of the record gives, over the highest frequency that is fitted. The fit uses ${
    band.cutoff[band.chosen]} Hz (filled), the widest band whose intervals are about the narrowest; how far the estimates of the other bands move is a part of the interval in the table.${
    refused ? ' Crosses are bands with too much noise or too few blocks; they are not chosen and may lie outside of the chart.' : ''}`);
}

// ---- friction over speed ----

function measuredTrace(points, name, colour, symbol) {
  return { name, x: points.map(p => Math.abs(p[0])), y: points.map(p => Math.abs(p[1])), mode: 'markers', type: 'scatter',
           error_y: { type: 'data', array: points.map(p => p[2]), color: colour, thickness: 1.2, width: 3 },
           marker: { color: colour, symbol, size: 8, line: { width: 1.3, color: colour } },
           hovertemplate: `${name}<br>%{y:.4~g} ${DATA.units.force} ± %{error_y.array:.2~g} ${DATA.units.force}<br>%{x:.4~g} ${DATA.units.speed}<extra></extra>` };
}

function drawCharacteristic() {
  const curve = DATA.curve;
  if (!curve) return document.getElementById('curve-section').remove();
  const band = (y, more) => ({ x: curve.speed, y, mode: 'lines', line: { width: 0 }, hoverinfo: 'skip', ...more });
  const traces = [band(curve.low, { name: 'band, low' }), band(curve.high, { name: 'band', fill: 'tonexty', fillcolor: 'var(--band)' }),
    { name: `${curve.curve} curve`, x: curve.speed, y: curve.force, mode: 'lines', line: { color: CURVE, width: 1.8 },
      hovertemplate: `${curve.curve} curve<br>%{y:.4~g} ${DATA.units.force}<br>%{x:.4~g} ${DATA.units.speed}<extra></extra>` },
    measuredTrace(curve.measured.filter(p => p[0] > 0), 'measured, +x', POSITIVE, 'circle'),
    measuredTrace(curve.measured.filter(p => p[0] < 0), 'measured, −x', NEGATIVE, 'square-open')].filter(trace => trace.x.length);
  drawChart('characteristic', traces, {
    margin: { l: 76, r: 24, t: 10, b: 46 },
    xaxis: axisStyle(`speed, ${DATA.units.speed}`, { type: 'log', tickformat: '~g', dtick: curve.speed.at(-1) / curve.speed[0] > 3000 ? 1 : 'D2' }),
    yaxis: axisStyle(`friction force, ${DATA.units.force}`, { rangemode: 'tozero', nticks: 7 }),
  });
  show('characteristic-caption', 'Points: force without the parts of mass and constant force, means over an eighth of a decade of the speed, with two standard errors; ',
       swatch({ colour: POSITIVE }), ' motion in +x, ', swatch({ colour: NEGATIVE }), ' in −x. Line: the ', element('strong', {}, curve.curve),
       ' curve with its 95 % band, the one with the least error on held-out data (a curve other than the linear one must explain at least 1 % more).');
  const errors = table([[text('Curve', { class: 'text' }), text('Held-out error'), text('Unit', { class: 'text unit' })]],
    curve.errors.map(row => classed('first', [{ text: row.curve, head: true, class: 'figure' },
                                              text(row.rms, { class: row.curve === curve.curve ? 'value' : null }), text(`${DATA.units.force} rms`, { class: 'text unit' })])));
  errors.className = 'bare';
  show('curve-errors', errors);
  show('curve-parameters', parameterTable(curve.parameters, false));
}

// ---- residuals ----

function drawResiduals() {
  if (!DATA.residuals.length) return document.getElementById('residual-section').remove();
  for (const log of DATA.residuals)
    for (const channel of ['time', 'speed', 'residual']) log[channel] = decodeFloats(log[channel]);
  const chart = (id, title, wide) => element('div', { class: wide ? 'wide' : null }, element('h2', {}, title), element('div', { id, class: 'plot low' }));
  const name = log => log.name.split('/').pop();
  show('residual-charts', ...DATA.residuals.map((log, i) => chart(`residual-${i}`, `Residual over time: ${name(log)}`, true)),
       chart('residual-speed', 'Residual over speed', true));
  const styles = stylesOf(DATA.residuals.map(log => log.name));
  if (DATA.residuals.length > 1) show('residual-key', ...DATA.residuals.map(log => element('span', {}, swatch(styles[log.name]), ` ${name(log)}`)));
  const margin = { l: 76, r: 24, t: 10, b: 46 };
  const force = axisStyle(`residual force, ${DATA.units.force}`, { zeroline: true, zerolinecolor: RULE, nticks: 7 });
  DATA.residuals.forEach((log, i) => drawChart(`residual-${i}`,
    [{ name: plain(name(log)), x: log.time, y: log.residual, mode: 'lines', line: { color: styles[log.name].colour, width: 1.1, simplify: false },
       hovertemplate: `%{y:.4~g} ${DATA.units.force}<br>%{x:.4~g} s<extra></extra>` }], { margin, xaxis: axisStyle('time, s'), yaxis: force }));
  drawChart('residual-speed', DATA.residuals.map(log => (
    { name: plain(name(log)), x: log.speed, y: log.residual, mode: 'markers', type: 'scatter',
      marker: { color: styles[log.name].colour, size: 3, opacity: 0.5 }, hovertemplate: `${plain(name(log))}<br>%{y:.4~g} ${DATA.units.force}<br>%{x:.4~g} ${DATA.units.speed}<extra></extra>` })),
    { margin, xaxis: axisStyle(`speed, ${DATA.units.speed}`), yaxis: force });
}

drawConditions();
drawTables();
drawBand();
drawCharacteristic();
drawResiduals();
drawMachine();
drawForPaper();
drawSchemeSwitch();
