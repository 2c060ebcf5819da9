// What stands below each chart: cursors, and the chart saved as a picture or as a table of its points.
'use strict';

// Labels of axes that show channels of a log, by their names in logs.
const LOG_CHANNELS = { 'time': 't', 'set position': 'x_set', 'set velocity': 'v_set', 'set acceleration': 'a_set', 'position': 'x',
                       'velocity': 'v', 'current': 'i', 'set current': 'i_set', 'force': 'F', 'motor force': 'F', 'voltage': 'u', 'temperature': 'temperature',
                       'external force': 'F_ext' };
const PICTURE = { width: 1200, legendRow: 24, perRow: 3 };  // pixels

// As the units of logs are spelled: "um", "m/s^2".
const logUnit = unit => unit.replaceAll('µ', 'u').replaceAll('²', '^2').replaceAll('√', 'sqrt ').replaceAll('°', 'deg');
const fileName = words => words.toLowerCase().replaceAll(/[^a-z0-9]+/g, '-').replaceAll(/^-|-$/g, '');
const quoted = field => /[",\n]/.test(field) ? `"${field.replaceAll('"', '""')}"` : field;

function titleOf(figure) {
  return figure.title || document.getElementById(figure.id).closest('section, div:has(> h2), div:has(> .heading)')?.querySelector('h2')?.textContent || figure.id;
}

const pageTitle = () => document.querySelector('h1').textContent;

function offer(name, address) {
  const link = element('a', { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

// ---- table of points ----

// "t[s]", "i[A]"; of several series "current of C LuGre[A]".
function columnName(axisLabel, series) {
  const [name, unit] = quantity(axisLabel);
  const channel = LOG_CHANNELS[name], own = !series || (channel && series === 'measured');
  return `${(own ? channel || name : `${channel || name} of ${series}`).replaceAll(',', '')}[${logUnit(unit)}]`;
}

const sameValues = (a, b) => a.length === b.length && a.every((value, i) => value === b[i]);

// The shown series, one abscissa for those that share it, as lines of RFC 4180 with "# key: value" before them.
function csvOf(figure) {
  const traces = figure.traces.filter(readable), columns = [];
  const several = traces.length > 1;
  traces.forEach((trace, k) => {
    const name = unplain(trace.name || ''), x = axisTitle(figure, trace, 'x'), y = axisTitle(figure, trace, 'y');
    const before = traces[k - 1];
    if (!before || axisTitle(figure, before, 'x') !== x || !sameValues(before.x, trace.x))
      columns.push({ name: columnName(x, several && traces.some(each => !sameValues(each.x, trace.x)) ? name : ''), values: trace.x });
    columns.push({ name: columnName(y, several ? name : ''), values: trace.y });
    if (trace.error_y) columns.push({ name: columnName(`standard errors (two) of ${y}`, several ? name : ''), values: trace.error_y.array });
  });
  const rows = Math.max(0, ...columns.map(column => column.values.length));
  const cell = value => value === undefined || !Number.isFinite(value) ? '' : String(Number(value.toPrecision(7)));
  const comments = [['page', pageTitle()], ['chart', titleOf(figure)], ['made by', document.querySelector('.command').textContent],
                    ['points', 'those that are drawn; long records are drawn from a choice that keeps their extremes']];
  return [...comments.map(([key, value]) => `# ${key}: ${value.replaceAll('\n', ' ')}`), columns.map(column => quoted(column.name)).join(','),
          ...Array.from({ length: rows }, (_, i) => columns.map(column => cell(column.values[i])).join(','))].join('\r\n') + '\r\n';
}

// ---- picture ----

// With title and legend, which the page has outside of the chart.
function pictureOf(figure, format) {
  const node = document.getElementById(figure.id), named = new Set();
  const traces = figure.traces.map(trace => {
    const first = readable(trace) && !named.has(trace.name);
    named.add(trace.name);
    return { ...trace, showlegend: first, legendgroup: trace.name };
  });
  const layout = shownLayout(figure), margin = layout.margin || {};
  const rows = named.size > 1 ? Math.ceil(named.size / PICTURE.perRow) : 0;
  const extra = { top: 40, bottom: rows * PICTURE.legendRow + (rows ? 14 : 0) };
  const height = node.clientHeight * Math.max(1, Math.min(1.6, PICTURE.width / node.clientWidth));
  const ranges = Object.fromEntries(Object.entries(node._fullLayout).filter(([key]) => /^[xy]axis\d*$/.test(key)).map(([key, axis]) =>
    [key, { ...layout[key], range: axis.range.slice(), autorange: false, ...(/^x/.test(key) && !layout[key]?.title?.text && figure.abscissa ? axisStyle(plain(figure.abscissa), { showticklabels: true }) : {}) }]));
  const square = node.classList.contains('square');
  const size = { width: square ? 900 : PICTURE.width, height: (square ? 900 : height) + extra.top + extra.bottom };
  return Plotly.toImage({ data: resolved(traces), layout: resolved({
    ...layout, ...ranges, autosize: false, ...size, paper_bgcolor: 'var(--paper)', showlegend: rows > 0,
    title: { text: plain(`${titleOf(figure)} · ${pageTitle()}`), font: { size: 15 }, x: 0.02, xanchor: 'left', y: 1, yanchor: 'top', pad: { t: 14 } },
    legend: { orientation: 'h', yref: 'container', y: 0, yanchor: 'bottom', x: 0.5, xanchor: 'center', entrywidth: 250 },
    margin: { ...margin, t: (margin.t ?? 10) + extra.top, b: Math.max(46, margin.b ?? 46) + extra.bottom } }) }, { format, ...size, scale: format === 'png' ? 2 : 1 });
}

// ---- the buttons ----

function addTools(figure) {
  const node = document.getElementById(figure.id), id = figure.id;
  const name = extension => `${fileName(`${DATA.machine.id} ${titleOf(FIGURES.get(id))}`)}.${extension}`;
  const button = (words, title, act) => {
    const made = element('button', { type: 'button', title }, words);
    made.addEventListener('click', () => act(FIGURES.get(id)));
    return made;
  };
  const cursors = button('Cursors', `Two cursors with differences. ${CURSOR_KEYS}`, toggleCursors);
  cursors.setAttribute('aria-pressed', 'false');
  figure.button = cursors;
  figure.readout = element('dl', { class: 'readout', role: 'status', hidden: true });
  const picture = format => button(format.toUpperCase(), `Save this chart as a picture (${format.toUpperCase()})`, async shown => offer(name(format), await pictureOf(shown, format)));
  const points = button('CSV', 'Save the shown points as a table (CSV)', shown => offer(name('csv'), `data:text/csv;charset=utf-8,${encodeURIComponent(csvOf(shown))}`));
  node.after(element('div', { class: 'tools on-screen', 'data-of': id }, cursors, element('span', { class: 'quiet' }, 'save as'), picture('png'), picture('svg'), points), figure.readout);
  listenToCursors(id);
}
